//! XML, parsed in time and memory proportional to it: without a document type, and without the tags whose attributes
//! or namespaces the parser would compare each with each.

use roxmltree::{Document, Node, ParsingOptions};

use super::error::{ImportError, fault};
use super::source::Source;
use crate::dataset::Place;

/// No format that is read has so many attributes in a tag, or namespaces in a file.
const MOST_ATTRIBUTES: usize = 200;
/// A million values with an element each, and more elements around them than there are.
const MOST_NODES: u32 = 8_000_000;

/// A parsed file.
#[derive(Debug)]
pub(super) struct Xml<'a> {
    source: &'a Source,
    tree: Document<'a>,
    /// Where each line begins, as bytes of the text.
    lines: Vec<usize>,
}

impl<'a> Xml<'a> {
    /// Parses a file.
    ///
    /// # Errors
    /// [`ImportError::Malformed`] with the line for what is no XML, and for a document type.
    pub(super) fn parse(source: &'a Source) -> Result<Self, ImportError> {
        let text = source.text.content.as_str();
        let malformed = |place: Place, found: String, advice: &str| {
            ImportError::Malformed(fault(place, found, "well-formed XML without a document type", advice))
        };
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        if let Some(at) = crowded(text) {
            let line = text[..at].matches('\n').count() as u64 + 1;
            let found = format!("a tag with more than {MOST_ATTRIBUTES} attributes, or so many namespaces");
            return Err(malformed(source.at_line(line), found, "export it again"));
        }
        let options = ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
        match Document::parse_with_options(text.trim_end(), options) {
            Ok(tree) => Ok(Self { source, tree, lines }),
            Err(error) => {
                let line = u64::from(error.pos().row);
                Err(malformed(source.at_line(line), format!("a fault of the XML ({error})"), "export it again"))
            }
        }
    }

    /// The outermost element.
    pub(super) fn root(&self) -> Node<'_, 'a> {
        self.tree.root_element()
    }

    /// Where an element stands.
    pub(super) fn place(&self, node: Node<'_, '_>) -> Place {
        let start = node.range().start;
        self.source.at_line(self.lines.partition_point(|line| *line <= start) as u64)
    }
}

/// The children of that name, whatever their namespace.
pub(super) fn children<'n, 'a: 'n>(node: Node<'n, 'a>, name: &'static str) -> impl Iterator<Item = Node<'n, 'a>> {
    node.children().filter(move |child| child.is_element() && child.tag_name().name() == name)
}

/// The first child of that name.
pub(super) fn child<'n, 'a: 'n>(node: Node<'n, 'a>, name: &'static str) -> Option<Node<'n, 'a>> {
    children(node, name).next()
}

/// The text of an element, without that of elements in it.
pub(super) fn text(node: Node<'_, '_>) -> String {
    node.children().filter(Node::is_text).filter_map(|part| part.text()).collect::<String>().trim().to_owned()
}

/// The text of the first child of that name, if there is some.
pub(super) fn child_text(node: Node<'_, '_>, name: &'static str) -> Option<String> {
    child(node, name).map(text).filter(|text| !text.is_empty())
}

/// Where a tag has too many attributes, or the file too many namespaces.
fn crowded(text: &str) -> Option<usize> {
    if let Some((at, _)) = text.match_indices("xmlns").nth(MOST_ATTRIBUTES) {
        return Some(at);
    }
    let mut at = 0;
    while let Some(start) = text[at..].find('<').map(|found| at + found) {
        let rest = &text[start..];
        let passed = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];
        if let Some((open, close)) = passed.iter().find(|(open, _)| rest.starts_with(open)) {
            at = start + open.len() + rest[open.len()..].find(close)?;
            continue;
        }
        let (mut quote, mut attributes) = (None, 0);
        let end = rest.bytes().position(|byte| {
            match (byte, quote) {
                (b'"' | b'\'', None) => quote = Some(byte),
                (byte, Some(open)) if byte == open => quote = None,
                (b'=', None) => attributes += 1,
                (b'>', None) => return true,
                _ => {}
            }
            attributes > MOST_ATTRIBUTES
        });
        if attributes > MOST_ATTRIBUTES {
            return Some(start);
        }
        at = start + end?;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crowded_tag_is_seen_before_it_is_parsed() {
        let many: String = (0..300).map(|k| format!(" a{k}='>'")).collect();
        assert_eq!(crowded(&format!("<a><b{many}/></a>")), Some(3));
        assert_eq!(crowded(&format!("<!--<b{many}/>--><a><![CDATA[<b{many}]]></a>")), None);
        assert!(crowded(&"<a xmlns='b'>".repeat(300)).is_some());
    }
}
