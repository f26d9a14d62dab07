//! A data file of the collection.

use std::path::PathBuf;

use super::models::response;

#[derive(Debug, Clone)]
pub struct Problem {
    pub name: String,
    /// `Lower`, `Average` or `Higher`.
    pub difficulty: String,
    pub starts: [Vec<f64>; 2],
    /// Certified to 11 digits.
    pub parameters: Vec<f64>,
    pub deviations: Vec<f64>,
    pub residual_sum: f64,
    pub response: Vec<f64>,
    pub predictors: Vec<Vec<f64>>,
}

pub fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/nist_strd")
}

pub fn read(name: &str) -> Problem {
    let text = std::fs::read_to_string(folder().join(format!("{name}.dat"))).unwrap();
    let numbers = |line: &str| line.split_whitespace().map(|word| word.parse().unwrap()).collect::<Vec<f64>>();
    let table: Vec<Vec<f64>> = text
        .lines()
        .filter(|line| line.trim_start().starts_with('b'))
        .filter_map(|line| line.split_once('='))
        .map(|(_, row)| numbers(row))
        .collect();
    let column = |k: usize| table.iter().map(|row| row[k]).collect::<Vec<f64>>();
    let after = |label: &str| text.lines().find_map(|line| line.trim().strip_prefix(label)).unwrap().trim().to_owned();
    let difficulty = text.lines().find(|line| line.contains("Level of Difficulty")).unwrap();
    // The last `Data:` heads the table; the first describes it.
    let rows: Vec<Vec<f64>> = text[text.rfind("\nData:").unwrap() + 1..]
        .lines()
        .skip(1)
        .filter(|line| !line.trim().is_empty())
        .map(numbers)
        .collect();
    assert_eq!(rows.len(), after("Number of Observations:").parse::<usize>().unwrap(), "{name}");
    Problem {
        name: name.to_owned(),
        difficulty: difficulty.split_whitespace().next().unwrap().to_owned(),
        starts: [column(0), column(1)],
        parameters: column(2),
        deviations: column(3),
        residual_sum: after("Residual Sum of Squares:").parse().unwrap(),
        response: rows.iter().map(|row| response(name, row[0])).collect(),
        predictors: rows.iter().map(|row| row[1..].to_vec()).collect(),
    }
}
