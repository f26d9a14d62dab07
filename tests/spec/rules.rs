//! The rules and profiles, from the registry.

use bbrf::validate::{CLAUSES, PROFILES, RULES};

use super::{code, markdown, titled};

pub fn rules() -> String {
    let mut body = String::new();
    for (number, group, title) in CLAUSES {
        let rows = RULES.iter().filter(|rule| rule.group() == *group).map(|rule| {
            let graded = PROFILES.iter().filter(|profile| profile.grade(rule) != rule.severity);
            let grades: Vec<String> =
                graded.map(|profile| format!("{}: {}", profile.name, profile.grade(rule).name())).collect();
            [
                code(rule.alias),
                code(rule.name()),
                rule.severity.name().to_owned(),
                grades.join(", "),
                rule.rationale.to_owned(),
                rule.example.to_owned(),
            ]
        });
        let head = ["alias", "rule", "severity", "in a profile", "why", "for example"];
        body.push_str(&format!("## Clause {number}: {title}\n\n{}\n", markdown(head, rows)));
    }
    let about =
        "The full id of a rule is `bbrf:1.0:` and its name. Neither id nor alias is ever used again for another rule.";
    titled("Rules", about, body.trim_end()) + "\n"
}

pub fn profiles() -> String {
    let rows = PROFILES.iter().map(|profile| {
        let grades =
            profile.grades.iter().map(|(name, grade)| format!("`{name}` {}", grade.name())).collect::<Vec<_>>();
        [code(profile.name), profile.purpose.to_owned(), grades.join(", ")]
    });
    let about = "A profile grades rules, or all rules of a group, anew; a rule whose severity is error stays one.";
    titled("Profiles", about, &markdown(["profile", "for", "grades"], rows))
}
