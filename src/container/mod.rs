//! The document as an HDF5 file: one table of every path and name, writing through libhdf5, reading through a pure-Rust
//! reader, and the digest of the content.
//!
//! A document becomes a tree of groups, datasets and attributes (`encode`), which alone knows the layout; the tree
//! becomes bytes (`write`), which alone knows libhdf5. Reading goes the same way back (`read`, `decode`).
//!
//! *May use:* `dataset`, `quantity`.
//!
//! *Invariant:* what is written is read back to the bit; the same document gives the same bytes; a file on disk is the
//! old one or the new one. Whatever the bytes, reading ends in a document or an error, within [`Limits`].

mod checksum;
mod chunk_table;
mod decode;
mod descriptions;
mod differing;
mod digest;
mod encode;
mod encoding;
mod error;
mod expected;
mod fields;
mod file_bytes;
mod foreign;
pub mod layout;
mod limits;
mod links;
mod open;
mod read;
pub mod replace;
mod storing;
#[doc(hidden)]
pub use crate::dataset::tree;
#[cfg(feature = "write")]
mod write;

pub use chunk_table::Chunks;
pub use differing::Differing;
pub use digest::{Digest, digest, measurement_digest};
pub use encoding::{Construct, Encoded};
pub use error::{EncodeError, ReadError, WriteError};
pub(crate) use expected::in_words;
pub use file_bytes::FileBytes;
pub use foreign::Foreign;
pub use limits::Limits;
pub use open::{Inspection, Mismatch, Opened, inspect, open, open_to_rewrite, open_verified, read_bytes, read_file};
pub use read::part::{Part, read_part};
pub use storing::Storing;

#[cfg(feature = "write")]
pub use save::{
    document_bytes, document_tree, rewrite, rewrite_storing, sign_tree, tree_bytes, unchecked_bytes, write_file,
    write_file_keeping, write_file_storing,
};

#[cfg(feature = "write")]
mod save;
