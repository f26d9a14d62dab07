//! The bytes of a file, held once however many parts look at them.

use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::ops::Deref;
use std::path::Path;
use std::sync::Arc;

/// The bytes of a file. A clone shares them; a vector is taken as it is, a slice is copied.
#[derive(Clone)]
pub struct FileBytes(Arc<Vec<u8>>);

impl FileBytes {
    /// Reads a file of at most so many bytes, a large one over all cores.
    ///
    /// # Errors
    /// What the operating system says; [`io::ErrorKind::FileTooLarge`] before any of a larger file is read, and
    /// [`io::ErrorKind::OutOfMemory`] where there is no room for it.
    pub fn read(path: &Path, most: u64) -> io::Result<Self> {
        let file = File::open(path)?;
        let described = file.metadata()?;
        not_above(described.len(), most)?;
        if is_endless(&described) {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "a device and no file"));
        }
        let length = usize::try_from(described.len()).unwrap_or(usize::MAX);
        if let Some(bytes) = in_parts(&file, &described, length)? {
            return Ok(bytes.into());
        }
        let mut bytes = room(length)?;
        // A pipe does not say beforehand how much it gives.
        file.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
        not_above(bytes.len() as u64, most)?;
        Ok(bytes.into())
    }
}

fn not_above(length: u64, most: u64) -> io::Result<()> {
    if length <= most {
        return Ok(());
    }
    Err(io::Error::new(io::ErrorKind::FileTooLarge, format!("more than the {most} bytes that are read at most")))
}

/// Room for so many bytes, asked for in a way that can be refused.
fn room(length: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(length)?;
    Ok(bytes)
}

/// True for a device, which may give bytes for ever; a pipe ends.
#[cfg(unix)]
fn is_endless(described: &Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;

    described.file_type().is_char_device() || described.file_type().is_block_device()
}

#[cfg(not(unix))]
fn is_endless(_: &Metadata) -> bool {
    false
}

/// The parts of a large regular file, each read by whoever is free; `None` for other files, and where it is written to
/// while it is read.
#[cfg(unix)]
fn in_parts(file: &File, described: &Metadata, length: usize) -> io::Result<Option<Vec<u8>>> {
    use std::os::unix::fs::FileExt;

    use rayon::iter::{IndexedParallelIterator, ParallelIterator};
    use rayon::slice::ParallelSliceMut;

    /// Bytes of a part.
    const PART: usize = 4 << 20;
    if !described.is_file() || length <= PART {
        return Ok(None);
    }
    // Asked first, because zeroed memory that is not there ends the program.
    drop(room(length)?);
    let mut bytes = vec![0; length];
    let parts = bytes.par_chunks_mut(PART).enumerate();
    let read = parts.map(|(part, bytes)| file.read_exact_at(bytes, (part * PART) as u64));
    let complete = read.collect::<io::Result<()>>().is_ok() && file.metadata()?.len() == described.len();
    Ok(complete.then_some(bytes))
}

#[cfg(not(unix))]
fn in_parts(_: &File, _: &Metadata, _: usize) -> io::Result<Option<Vec<u8>>> {
    Ok(None)
}

impl Deref for FileBytes {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        &self.0
    }
}

impl AsRef<[u8]> for FileBytes {
    fn as_ref(&self) -> &[u8] {
        self
    }
}

impl std::fmt::Debug for FileBytes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} bytes", self.len())
    }
}

impl From<Vec<u8>> for FileBytes {
    fn from(bytes: Vec<u8>) -> Self {
        Self(Arc::new(bytes))
    }
}

impl From<&Vec<u8>> for FileBytes {
    fn from(bytes: &Vec<u8>) -> Self {
        bytes.clone().into()
    }
}

impl From<&[u8]> for FileBytes {
    fn from(bytes: &[u8]) -> Self {
        bytes.to_vec().into()
    }
}

impl From<&Self> for FileBytes {
    fn from(bytes: &Self) -> Self {
        bytes.clone()
    }
}
