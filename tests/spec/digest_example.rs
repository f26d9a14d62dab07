//! The worked example of clause 2: a document of one title, byte by byte, computed here without the library.

use bbrf::dataset::Document;
use sha2::{Digest as _, Sha256};

use super::titled;

/// Bytes in parts, each with what it is.
type Parts = Vec<(Vec<u8>, String)>;

/// The document of the example.
pub fn document() -> Document {
    Document { title: Some("a".to_owned()), ..Document::default() }
}

/// A text as the digest takes it, with what it is.
fn text(bytes: &mut Parts, text: &str) {
    bytes.push(((text.len() as u64).to_le_bytes().to_vec(), format!("{} bytes follow", text.len())));
    bytes.push((text.as_bytes().to_vec(), format!("`{text}`")));
}

/// A scalar text as an array.
fn scalar(bytes: &mut Parts, value: &str) {
    text(bytes, "string");
    bytes.push((0_u64.to_le_bytes().to_vec(), "no axes: a scalar".to_owned()));
    text(bytes, value);
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Path and bytes of every object.
fn objects() -> Vec<(&'static str, Parts)> {
    let mut root = Vec::new();
    text(&mut root, "group");
    text(&mut root, "title");
    scalar(&mut root, "a");
    let mut provenance = Vec::new();
    text(&mut provenance, "group");
    let mut list = Vec::new();
    text(&mut list, "dataset");
    scalar(&mut list, "[]");
    vec![("/", root), ("/provenance", provenance), ("/provenance/receipts", list.clone()), ("/provenance/steps", list)]
}

/// SHA-256 of every object, and the digest of the document.
pub fn digests() -> (Vec<(&'static str, String)>, String) {
    let of = |parts: &Parts| {
        let all: Vec<u8> = parts.iter().flat_map(|(bytes, _)| bytes.clone()).collect();
        hexadecimal(&Sha256::digest(all))
    };
    let objects: Vec<(&str, String)> = objects().iter().map(|(path, parts)| (*path, of(parts))).collect();
    let lines: String = objects.iter().map(|(path, digest)| format!("{digest} {path}\n")).collect();
    (objects, format!("sha256:{}", hexadecimal(&Sha256::digest(lines))))
}

fn body() -> String {
    let (digests, document) = digests();
    let mut body = String::new();
    for ((path, parts), (_, digest)) in objects().iter().zip(&digests) {
        body.push_str(&format!("`{path}`\n\n```\n"));
        for (bytes, what) in parts {
            body.push_str(&format!("{:<24} {what}\n", hexadecimal(bytes)));
        }
        body.push_str(&format!("sha256 = {digest}\n```\n\n"));
    }
    body.push_str("The document: SHA-256 of these lines, each ended by 0a\n\n```\n");
    digests.iter().for_each(|(path, digest)| body.push_str(&format!("{digest} {path}\n")));
    body.push_str(&format!("digest = {document}\n```\n"));
    body
}

/// The generated file.
pub fn table() -> String {
    let about = "A document whose `title` is `a`, and nothing else. Its attributes `Conventions` and `bbrf_version` are in no \
                 digest. Left: the bytes that are hashed, one after the other; right: what they are.";
    titled("Worked example of the digests", about, &body())
}
