//! Unfinished files of killed processes.
//!
//! A writer holds a lock on its unfinished file, and the system releases it when the process ends, however it ends. So an
//! unfinished file that can be locked is nobody's and is removed. No clock and no process id is asked: both lie on a disk
//! that several machines write to. Where the system or the disk has no such locks nothing is removed.

use std::ffi::OsStr;
use std::fs::File;
use std::io;
use std::path::Path;

/// Locks a file just created; false where somebody took it for abandoned before that and removed it.
#[cfg(unix)]
pub(super) fn claim(file: &File) -> io::Result<bool> {
    use std::os::unix::fs::MetadataExt;
    // A disk without locks refuses, and then nobody else gets one either.
    let _ = rustix::fs::flock(file, rustix::fs::FlockOperation::LockExclusive);
    Ok(file.metadata()?.nlink() > 0)
}

/// Removes the unfinished files of that prefix that no running process holds. What cannot be removed stays: it is in
/// nobody's way.
#[cfg(unix)]
pub(super) fn remove_abandoned(folder: &Path, prefix: &OsStr) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten().filter(|entry| is_unfinished(&entry.file_name(), prefix)) {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        let Some(file) = is_file.then(|| File::open(entry.path()).ok()).flatten() else { continue };
        // Removed while the lock is held, so that its owner, if it is just being created, sees that it is gone.
        if rustix::fs::flock(&file, rustix::fs::FlockOperation::NonBlockingLockExclusive).is_ok() {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// True for PREFIX, six letters or digits, and the suffix.
#[cfg(unix)]
fn is_unfinished(name: &OsStr, prefix: &OsStr) -> bool {
    use std::os::unix::ffi::OsStrExt;
    let middle =
        name.as_bytes().strip_prefix(prefix.as_bytes()).and_then(|rest| rest.strip_suffix(super::SUFFIX.as_bytes()));
    middle.is_some_and(|middle| middle.len() == super::RANDOM_LETTERS && middle.iter().all(u8::is_ascii_alphanumeric))
}

#[cfg(not(unix))]
pub(super) fn claim(_file: &File) -> io::Result<bool> {
    Ok(true)
}

#[cfg(not(unix))]
pub(super) fn remove_abandoned(_folder: &Path, _prefix: &OsStr) {}

#[cfg(all(test, unix))]
mod tests {
    use super::super::write_whole;
    use super::*;
    use std::io::Write;

    #[test]
    fn what_a_killed_process_left_goes_and_what_a_running_one_writes_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let kept =
            [".a.csv.Held01.partial", ".b.csv.Other1.partial", ".a.csv.notes.partial", ".a.csv.Abcde1.partial.gz"];
        for name in kept.into_iter().chain([".a.csv.Dead01.partial"]) {
            std::fs::write(path(name), "half").unwrap();
        }
        let held = File::open(path(kept[0])).unwrap();
        assert!(claim(&held).unwrap());
        write_whole(&path("a.csv"), |file| file.write_all(b"new")).unwrap();
        assert!(!path(".a.csv.Dead01.partial").exists());
        assert!(kept.iter().all(|name| path(name).exists()));
        drop(held);
        write_whole(&path("a.csv"), |file| file.write_all(b"newer")).unwrap();
        assert!(!path(kept[0]).exists(), "its owner is gone now");
    }

    #[test]
    fn a_file_removed_before_it_was_claimed_is_not_written_to() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(".a.csv.Taken1.partial");
        let file = File::create(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        assert!(!claim(&file).unwrap());
    }
}
