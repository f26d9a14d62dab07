//! The bytes of a file, held once however many parts look at them.

use std::io;
use std::ops::Deref;
use std::path::Path;
use std::sync::Arc;

/// The bytes of a file. A clone shares them; a vector is taken as it is, a slice is copied.
#[derive(Clone)]
pub struct FileBytes(Arc<Vec<u8>>);

impl FileBytes {
    /// Reads a file, a large one over all cores.
    ///
    /// # Errors
    /// What the operating system says.
    pub fn read(path: &Path) -> io::Result<Self> {
        match in_parts(path)? {
            Some(bytes) => Ok(bytes.into()),
            None => std::fs::read(path).map(Self::from),
        }
    }
}

/// The parts of a large regular file, each read by whoever is free; `None` for other files, and where it is written to
/// while it is read.
#[cfg(unix)]
fn in_parts(path: &Path) -> io::Result<Option<Vec<u8>>> {
    use std::os::unix::fs::FileExt;

    use rayon::iter::{IndexedParallelIterator, ParallelIterator};
    use rayon::slice::ParallelSliceMut;

    /// Bytes of a part.
    const PART: usize = 4 << 20;
    let file = std::fs::File::open(path)?;
    let described = file.metadata()?;
    let length = usize::try_from(described.len()).unwrap_or(0);
    if !described.is_file() || length <= PART {
        return Ok(None);
    }
    let mut bytes = vec![0; length];
    let parts = bytes.par_chunks_mut(PART).enumerate();
    let read = parts.map(|(part, bytes)| file.read_exact_at(bytes, (part * PART) as u64));
    let complete = read.collect::<io::Result<()>>().is_ok() && file.metadata()?.len() == described.len();
    Ok(complete.then_some(bytes))
}

#[cfg(not(unix))]
fn in_parts(_: &Path) -> io::Result<Option<Vec<u8>>> {
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
