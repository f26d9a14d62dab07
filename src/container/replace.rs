//! The only place that creates files. Whoever opens the path sees the old file or the new one, whole, whatever happens
//! in between.

mod abandoned;

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use abandoned::{claim, remove_abandoned};

/// Random letters and digits in the name of an unfinished file.
const RANDOM_LETTERS: usize = 6;
/// How the name of an unfinished file ends.
const SUFFIX: &str = ".partial";

/// Writes a file through `fill` and puts it in the place of `path` when it is complete and on the disk.
///
/// The bytes go to a hidden file in the same folder (`.NAME.XXXXXX.partial`), which is removed when anything fails. A
/// killed process may leave it behind, under a name that no program takes for a result; on Unix the next write of the same
/// file removes it. A link is followed, and the permissions of an old file are kept.
///
/// # Errors
/// What `fill` or the operating system reports; then `path` is untouched.
pub fn write_whole<F>(path: &Path, fill: F) -> io::Result<()>
where
    F: FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
{
    let target = resolved(path)?;
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let partial = partial_file(&target, folder)?;
    let mut writer = BufWriter::new(partial.as_file());
    fill(&mut writer)?;
    writer.flush()?;
    drop(writer);
    if let Ok(old) = fs::metadata(&target) {
        partial.as_file().set_permissions(old.permissions())?;
    }
    partial.as_file().sync_all()?;
    partial.persist(&target).map_err(|error| error.error)?;
    sync_folder(folder)
}

/// Where a link leads, so that the file is replaced and not the link.
fn resolved(path: &Path) -> io::Result<PathBuf> {
    match fs::symlink_metadata(path) {
        Ok(metadata) if metadata.is_symlink() => match fs::canonicalize(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(path.to_owned()),
            canonical => canonical,
        },
        _ => Ok(path.to_owned()),
    }
}

fn partial_file(target: &Path, folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let name = target.file_name().ok_or_else(|| {
        io::Error::new(io::ErrorKind::InvalidInput, format!("{} does not name a file", target.display()))
    })?;
    let mut prefix = OsString::from(".");
    prefix.push(name);
    prefix.push(".");
    remove_abandoned(folder, &prefix);
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).rand_bytes(RANDOM_LETTERS).suffix(SUFFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // What any program would create; the process's umask still applies.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    loop {
        let partial = builder.tempfile_in(folder)?;
        if claim(partial.as_file())? {
            return Ok(partial);
        }
    }
}

/// Makes the rename itself durable.
#[cfg(unix)]
fn sync_folder(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}

/// Other systems have no such call for folders.
#[cfg(not(unix))]
fn sync_folder(_folder: &Path) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_leaves_the_old_file_and_no_other() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        write_whole(&path, |file| file.write_all(b"old")).unwrap();
        let refused = write_whole(&path, |file| {
            file.write_all(b"half of the new")?;
            Err(io::Error::other("the source ended"))
        });
        assert!(refused.is_err());
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_followed_and_permissions_are_kept() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("real"), folder.path().join("link"));
        fs::write(&path, "old").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&path, &link).unwrap();
        write_whole(&link, |file| file.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
    }

    #[test]
    fn a_missing_folder_is_an_error() {
        assert!(write_whole(Path::new("/nonexistent-folder/a"), |_| Ok(())).is_err());
        assert!(write_whole(Path::new("/"), |_| Ok(())).is_err());
    }
}
