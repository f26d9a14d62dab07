//! `bbrf rules` and `bbrf explain`: what is checked, and why.

use miette::miette;
use schemars::JsonSchema;
use serde::Serialize;

use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::output::{print_json, print_text};
use crate::validate::{PROFILES, RULES, Rule, Severity, UnknownRule, rule};

/// List the rules.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Say what a rule checks and why.
#[derive(Debug, clap::Args)]
pub(crate) struct ExplainArguments {
    /// Id or alias of the rule, or a group, as in geometry.polar-range, BB0401 or geometry
    rule: String,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// What `--json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct RulesResult {
    rules: Vec<RuleText>,
}

/// One rule.
#[derive(Debug, Serialize, JsonSchema)]
struct RuleText {
    id: &'static str,
    alias: &'static str,
    severity: Severity,
    /// The clause of the specification that it checks.
    clause: u8,
    /// What the specification demands, in its words.
    demands: Vec<String>,
    rationale: &'static str,
    /// An example of a violation.
    example: &'static str,
    /// What to do about it.
    repair: &'static str,
}

impl From<&Rule> for RuleText {
    fn from(rule: &Rule) -> Self {
        let Rule { id, alias, severity, rationale, example, repair, .. } = rule;
        Self {
            id,
            alias,
            severity: *severity,
            clause: rule.clause(),
            demands: rule.demands(),
            rationale,
            example,
            repair,
        }
    }
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    if arguments.json {
        print_json("bbrf:rules:1", &RulesResult { rules: RULES.iter().map(RuleText::from).collect() })?;
    } else {
        let line = |rule: &Rule| format!("{}  {:7}  {}", rule.alias, rule.severity.name(), rule.id);
        print_text(&RULES.iter().map(line).collect::<Vec<_>>().join("\n"))?;
    }
    Ok(Outcome::Done)
}

pub(crate) fn explain(arguments: &ExplainArguments) -> CommandResult {
    let group: Vec<&Rule> = RULES.iter().filter(|rule| rule.group() == arguments.rule).collect();
    if !group.is_empty() {
        let line =
            |rule: &&Rule| format!("{}  {:7}  {}: {}", rule.alias, rule.severity.name(), rule.id, rule.rationale);
        if arguments.json {
            print_json("bbrf:rules:1", &RulesResult { rules: group.into_iter().map(RuleText::from).collect() })?;
        } else {
            print_text(&group.iter().map(line).collect::<Vec<_>>().join("\n"))?;
        }
        return Ok(Outcome::Done);
    }
    let rule = rule(&arguments.rule)
        .ok_or_else(|| miette!(help = "bbrf rules lists them", "{}", UnknownRule(arguments.rule.clone())))?;
    if arguments.json {
        print_json("bbrf:rules:1", &RulesResult { rules: vec![rule.into()] })?;
    } else {
        print_text(&explained(rule))?;
    }
    Ok(Outcome::Done)
}

/// What people want to know of a rule.
fn explained(rule: &Rule) -> String {
    let graded = PROFILES.iter().filter(|profile| profile.grade(rule) != rule.severity);
    let grades: Vec<String> =
        graded.map(|profile| format!("{} under --profile {}", profile.grade(rule).name(), profile.name)).collect();
    let grades = if grades.is_empty() { String::new() } else { format!(" ({})", grades.join(", ")) };
    format!(
        "{} ({}), {}{grades}\n\nClause {} of the specification: {}\n\nWhy: {}\nA violation: {}.\nRepair: {}",
        rule.id,
        rule.alias,
        rule.severity.name(),
        rule.clause(),
        rule.demands().join(" "),
        rule.rationale,
        rule.example,
        rule.repair
    )
}
