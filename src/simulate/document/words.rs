//! Values that are a number or a word, read so that a wrong one is told what was expected.

use std::fmt;

use serde::de::{Deserializer, Error, Unexpected, Visitor};
use serde::ser::Serializer;

use crate::donaldson::Observer;
use crate::simulate::scene::Bounces;

/// `"all"`, or a whole number.
pub(super) fn bounces<'de, D: Deserializer<'de>>(from: D) -> Result<Bounces, D::Error> {
    struct Reader;
    impl Visitor<'_> for Reader {
        type Value = Bounces;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("\"all\" or a whole number from 0 to 4294967295")
        }

        fn visit_i64<E: Error>(self, found: i64) -> Result<Bounces, E> {
            u32::try_from(found).map(Bounces::Most).map_err(|_| E::invalid_value(Unexpected::Signed(found), &self))
        }

        fn visit_u64<E: Error>(self, found: u64) -> Result<Bounces, E> {
            u32::try_from(found).map(Bounces::Most).map_err(|_| E::invalid_value(Unexpected::Unsigned(found), &self))
        }

        fn visit_str<E: Error>(self, found: &str) -> Result<Bounces, E> {
            if found == "all" { Ok(Bounces::All) } else { Err(E::invalid_value(Unexpected::Str(found), &self)) }
        }
    }
    from.deserialize_any(Reader)
}

/// 2 or 10.
pub(super) fn observer<'de, D: Deserializer<'de>>(from: D) -> Result<Observer, D::Error> {
    struct Reader;
    impl Visitor<'_> for Reader {
        type Value = Observer;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("2 or 10, degrees")
        }

        fn visit_i64<E: Error>(self, found: i64) -> Result<Observer, E> {
            found.to_string().parse().map_err(|_| E::invalid_value(Unexpected::Signed(found), &self))
        }

        fn visit_u64<E: Error>(self, found: u64) -> Result<Observer, E> {
            found.to_string().parse().map_err(|_| E::invalid_value(Unexpected::Unsigned(found), &self))
        }
    }
    from.deserialize_any(Reader)
}

/// The degrees of an observer as a number.
pub(super) fn observer_degrees<S: Serializer>(observer: &Observer, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_u8(match observer {
        Observer::Two => 2,
        Observer::Ten => 10,
    })
}
