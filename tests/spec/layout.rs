//! What stands where in a file, as the writer makes it: from a document with everything and one with as little as the
//! standard allows.

use std::collections::{BTreeMap, BTreeSet};

use bbrf::container::document_tree;
use bbrf::container::layout::{self, Entry, Kind, name};
use bbrf::container::tree::{Array, Group, Object};
use bbrf::dataset::Document;

use super::full::{full, minimal};
use super::{code, markdown, titled};

/// Lists whose members are named by identifiers.
const LISTS: [&str; 8] = [
    name::SAMPLE,
    name::INSTRUMENT,
    name::LIGHT,
    name::WHITE_REFERENCE,
    name::MEASUREMENT,
    name::MODEL,
    name::FACTORISATION,
    name::EXTENSION,
];

/// Attributes that every object of a kind has, and that the text describes once.
const EVERYWHERE: [&str; 4] = [name::UNITS, name::LONG_NAME, name::SHA256, name::DIGEST];

/// A path with `*` for identifiers and numbers.
fn pattern(path: &str) -> String {
    let names: Vec<&str> = path.split('/').filter(|name| !name.is_empty()).collect();
    let starred = |(depth, member): (usize, &&str)| match names.first() {
        Some(list) if depth == 1 && LISTS.contains(list) => "*".to_owned(),
        _ => numbered(member),
    };
    format!("/{}", names.iter().enumerate().map(starred).collect::<Vec<_>>().join("/"))
}

/// `term_3` and `parameter_0_u` with a star for the number.
fn numbered(member: &str) -> String {
    let prefixes = [name::TERM, name::PARAMETER, name::COMPONENT, "calibration_"];
    let Some(prefix) = prefixes.iter().find(|prefix| member.starts_with(**prefix)) else { return member.to_owned() };
    let rest = member[prefix.len()..].trim_start_matches(|c: char| c.is_ascii_digit());
    if rest.len() + prefix.len() == member.len() { member.to_owned() } else { format!("{prefix}*{rest}") }
}

/// What is known of a pattern.
#[derive(Debug, Default)]
struct Row {
    kind: String,
    axes: BTreeSet<String>,
    unit: String,
    meaning: String,
    seen: usize,
    parents: usize,
}

/// Rows by pattern, and which entries of the layout were seen.
struct Rows {
    rows: BTreeMap<String, Row>,
    used: BTreeSet<String>,
}

/// What gives a number its unit where the layout does not.
fn given_by(path: &str) -> &'static str {
    if path.contains("/covariance") {
        "of the two parameters"
    } else if path.contains("/parameter_") {
        "of the parameter"
    } else if path.starts_with("/model/") {
        "of the fitted number"
    } else {
        "of the quantity"
    }
}

fn shape(array: &Array) -> String {
    if array.shape.is_empty() {
        String::new()
    } else {
        format!("[{}]", array.shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", "))
    }
}

impl Rows {
    fn entry(&mut self, path: &str) -> &'static Entry {
        let entry = layout::find(path).unwrap_or_else(|| panic!("{path} is not in the layout"));
        self.used.insert(entry.path.to_string());
        entry
    }

    fn add(&mut self, path: &str, kind: String, axes: String, unit: &str) {
        let entry = self.entry(path);
        let (object, attribute) = path.split_once('@').map_or((path, None), |(object, name)| (object, Some(name)));
        let mut key = pattern(object);
        if let Some(attribute) = attribute {
            key = format!("{key}@{attribute}");
        }
        let row = self.rows.entry(key).or_default();
        row.kind = kind;
        if !axes.is_empty() {
            row.axes.insert(axes);
        }
        if row.unit.is_empty() {
            row.unit = unit.to_owned();
        }
        row.meaning = entry.meaning.to_string();
        row.seen += 1;
    }

    fn group(&mut self, group: &Group, path: &str) {
        let shown = if path.is_empty() { "/" } else { path };
        self.add(shown, "group".to_owned(), String::new(), "");
        self.attributes(shown, &Object::Group(group));
        for (name, dataset) in &group.datasets {
            let path = format!("{path}/{name}");
            let unit = dataset.attributes.get(name::UNITS).and_then(Array::as_text).unwrap_or("");
            if name.ends_with(name::INDEX) {
                self.entry(&path);
                continue;
            }
            let axes: Vec<String> = dataset.axes.iter().map(|axis| numbered(axis)).collect();
            let axes = match (dataset.is_scale, axes.is_empty()) {
                (true, _) => "scale".to_owned(),
                (false, true) => "scalar".to_owned(),
                (false, false) => axes.join(", "),
            };
            let unit = if self.entry(&path).unit == "*" { given_by(&path) } else { unit };
            self.add(&path, dataset.array.data.type_name().to_owned(), axes, unit);
            self.attributes(&path, &Object::Dataset(dataset));
        }
        for (name, child) in &group.groups {
            let path = format!("{path}/{name}");
            if path.starts_with("/extension/") {
                self.add(&path, "group".to_owned(), String::new(), "");
            } else {
                self.group(child, &path);
            }
        }
    }

    fn attributes(&mut self, path: &str, object: &Object<'_>) {
        for (name, array) in object.attributes() {
            let place = format!("{path}@{name}");
            let unit = match self.entry(&place).unit {
                "1" | "" => "",
                "*" => given_by(&place),
                unit => unit,
            };
            if !EVERYWHERE.contains(&name.as_str()) {
                let kind = format!("{}{}", array.data.type_name(), shape(array));
                self.add(&place, kind, String::new(), unit);
            }
        }
    }
}

/// How often each group or dataset occurs, by pattern.
fn parents(tree: &Group) -> BTreeMap<String, usize> {
    let mut count = BTreeMap::new();
    tree.visit("", &mut |path, _| *count.entry(pattern(path)).or_insert(0) += 1);
    count
}

fn collected() -> Rows {
    let mut rows = Rows { rows: BTreeMap::new(), used: BTreeSet::new() };
    let mut count: BTreeMap<String, usize> = BTreeMap::new();
    for document in [full(), minimal(), Document::default()] {
        let tree = document_tree(&document).unwrap();
        rows.group(&tree, "");
        parents(&tree).into_iter().for_each(|(path, seen)| *count.entry(path).or_insert(0) += seen);
    }
    for (path, row) in &mut rows.rows {
        let parent = match path.split_once('@') {
            Some((object, _)) => object,
            None => path.rsplit_once('/').map_or("/", |(parent, _)| if parent.is_empty() { "/" } else { parent }),
        };
        row.parents = count.get(parent).copied().unwrap_or(0);
    }
    rows
}

/// Entries of the layout that neither document has: the table would not have them.
pub fn missing() -> Vec<String> {
    let used = collected().used;
    let signed = [format!("/**@{}", name::SHA256), format!("/@{}", name::SHA256), format!("/@{}", name::DIGEST)];
    let all = layout::table().iter().map(|entry| entry.path.to_string());
    all.filter(|path| !used.contains(path) && !signed.contains(path)).collect()
}

/// A room of the file, and its order in the table.
fn room(path: &str) -> usize {
    let top = path.split(['/', '@']).nth(1).unwrap_or_default();
    let rooms =
        ["", "sample", "instrument", "light", "white_reference", "measurement", "model", "provenance", "extension"];
    rooms.iter().position(|room| *room == top).unwrap_or(0)
}

pub fn table() -> String {
    let rows = collected().rows;
    let titles = [
        "The root",
        "Samples",
        "Instruments",
        "Lights",
        "White references",
        "Measurements",
        "Models",
        "Provenance",
        "Extensions",
    ];
    let mut body = String::new();
    for (number, title) in titles.iter().enumerate() {
        let mut of_room: Vec<_> = rows.iter().filter(|(path, _)| room(path) == number).collect();
        // Attributes stand before the members of their group.
        of_room.sort_by_key(|(path, _)| path.replace('@', "/ "));
        let lines = of_room.into_iter().map(|(path, row)| {
            let always = if path == "/" || row.seen >= row.parents { "always" } else { "optional" };
            let axes = row.axes.iter().cloned().collect::<Vec<_>>().join("; or ");
            let kind = if axes.is_empty() { row.kind.clone() } else { format!("{} ({axes})", row.kind) };
            [
                code(path),
                kind,
                if row.unit.contains(' ') { row.unit.clone() } else { code(&row.unit) },
                always.to_owned(),
                row.meaning.clone(),
            ]
        });
        body.push_str(&format!(
            "## {title}\n\n{}\n",
            markdown(["path", "type (axes)", "unit", "there", "meaning"], lines)
        ));
    }
    let about = "`*` stands for an identifier or a number from 0; `@` precedes an attribute. Attributes are scalar unless a \
                 length stands behind their type. `always` means: wherever its group or dataset is. Every dataset whose \
                 unit is named has it as its attribute `units`, as have `value`, `value_u` and the parameters. Not listed: `sha256` on every object and `digest` on the root \
                 (clause 2), `long_name` on any dataset, and the scales `NAME_index` (clause 1).";
    debug_assert!(matches!(layout::find("/").map(|entry| entry.kind), Some(Kind::Group)));
    titled("Groups, datasets and attributes", about, &body)
}
