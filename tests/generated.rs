//! Generated files are in step with the code; `BBRF_UPDATE=1` writes them.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

use std::path::Path;

#[test]
fn schemas_are_in_step() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("schema");
    let update = std::env::var_os("BBRF_UPDATE").is_some();
    let schemas = bbrf::cli::schemas();
    for (name, schema) in &schemas {
        let path = folder.join(format!("{name}.json"));
        let text = serde_json::to_string_pretty(schema).unwrap() + "\n";
        if update {
            std::fs::create_dir_all(&folder).unwrap();
            std::fs::write(&path, &text).unwrap();
        }
        let stored = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(stored == text, "{} is not what the code gives; run with BBRF_UPDATE=1", path.display());
    }
    let files = std::fs::read_dir(&folder).unwrap().count();
    assert_eq!(files, schemas.len(), "a schema without a type");
}
