//! Links out of a file, and links that lead nowhere, make other libraries reject it: it is not valid here either.
#![cfg(feature = "write")]
#![allow(unsafe_code, clippy::unwrap_used, reason = "a test")]

mod documents;

use std::ffi::CString;
use std::path::Path;

use bbrf::container::write_file;
use bbrf::validate::{Severity, Status, validate_bytes};
use hdf5_sys::{h5, h5f, h5l, h5p};

/// Name, the other file of an external link, target.
type Link<'a> = (&'a str, Option<&'a str>, &'a str);

/// Adds links to a file as another program would.
fn with_links(path: &Path, links: &[Link<'_>]) -> Vec<u8> {
    let text = |text: &str| CString::new(text).unwrap();
    let _guard = hdf5_sys::LOCK.lock();
    // SAFETY: the lock is held, the file is open while it is changed, every text ends with NUL.
    unsafe {
        h5::H5open();
        let file = h5f::H5Fopen(text(path.to_str().unwrap()).as_ptr(), h5f::H5F_ACC_RDWR, h5p::H5P_DEFAULT);
        for (name, other_file, target) in links {
            let (name, target) = (text(name), text(target));
            let status = match other_file {
                Some(other) => {
                    let other = text(other);
                    let (list, access) = (h5p::H5P_DEFAULT, h5p::H5P_DEFAULT);
                    h5l::H5Lcreate_external(other.as_ptr(), target.as_ptr(), file, name.as_ptr(), list, access)
                }
                None => {
                    let (list, access) = (h5p::H5P_DEFAULT, h5p::H5P_DEFAULT);
                    h5l::H5Lcreate_soft(target.as_ptr(), file, name.as_ptr(), list, access)
                }
            };
            assert!(status >= 0);
        }
        h5f::H5Fclose(file);
    }
    std::fs::read(path).unwrap()
}

#[test]
fn links_out_of_the_file_and_to_nothing_are_errors() {
    let many: Vec<String> = (0..80).map(|number| format!("link{number}")).collect();
    let dense: Vec<Link<'_>> = many
        .iter()
        .map(|name| (name.as_str(), None, "/measurement"))
        .chain([("nowhere", None, "/measurement/none")])
        .collect();
    let cases: [(&[Link<'_>], &str); 4] = [
        (&[("nowhere", None, "/measurement/none")], "/nowhere"),
        (&[("measurement/scan/nowhere", None, "none")], "/measurement/scan/nowhere"),
        (&[("away", Some("other.h5"), "/data")], "other.h5"),
        (&dense, "/nowhere"),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (number, (links, named)) in cases.into_iter().enumerate() {
        let path = folder.path().join(format!("{number}.bbrf"));
        write_file(&documents::small(), &path).unwrap();
        let report = validate_bytes(with_links(&path, links));
        assert_ne!(report.status(), Status::Valid, "{named}");
        let error = report.findings.iter().find(|finding| finding.severity == Severity::Error).unwrap();
        assert!(format!("{} {}", error.place, error.found).contains(named), "{error:?}");
    }
}

#[test]
fn a_link_to_what_is_in_the_file_is_content_that_the_standard_does_not_know() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bbrf");
    write_file(&documents::small(), &path).unwrap();
    let report = validate_bytes(with_links(&path, &[("first", None, "/measurement/scan/value")]));
    assert!(report.findings.iter().all(|finding| finding.severity != Severity::Error), "{:?}", report.findings);
}
