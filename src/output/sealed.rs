//! Values as bytes, which are read back to the last bit or refused.
//!
//! The bytes are a mark, the SHA-256 digest of the value's bytes, and the value in the postcard format. Bytes with another mark and truncated or
//! changed bytes are refused.

use serde::Serialize;
use serde::de::DeserializeOwned;
use sha2::{Digest, Sha256};

/// Length of the digest [bytes].
const SUM: usize = 32;

/// Reason why bytes cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unreadable {
    /// The bytes begin with another mark.
    Mark,
    /// The bytes are truncated or changed.
    Damaged,
}

/// Returns a value as bytes that begin with a mark.
pub fn seal(mark: &[u8], value: &impl Serialize) -> Vec<u8> {
    let body = postcard::to_stdvec(value).expect("a value in memory can be written");
    [mark, Sha256::digest(&body).as_slice(), &body].concat()
}

/// Reads a value written by [`seal`].
///
/// # Errors
/// The bytes are not those of a value with this mark.
pub fn open<T: DeserializeOwned>(mark: &[u8], bytes: &[u8]) -> Result<T, Unreadable> {
    let rest = bytes.strip_prefix(mark).ok_or(Unreadable::Mark)?;
    let (sum, body) = rest.split_at_checked(SUM).ok_or(Unreadable::Damaged)?;
    if sum != Sha256::digest(body).as_slice() {
        return Err(Unreadable::Damaged);
    }
    postcard::from_bytes(body).map_err(|_| Unreadable::Damaged)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_survives_its_bytes_and_every_truncated_or_changed_one_is_refused() {
        let (mark, value) = (b"mark".as_slice(), (1.0_f64 / 3.0, vec![true, false], -0.0_f64));
        let bytes = seal(mark, &value);
        let back: (f64, Vec<bool>, f64) = open(mark, &bytes).unwrap();
        assert_eq!(format!("{back:?}"), format!("{value:?}"));
        let read = |bytes: &[u8]| open::<(f64, Vec<bool>, f64)>(mark, bytes);
        for length in 0..bytes.len() {
            assert!(read(&bytes[..length]).is_err(), "{length}");
        }
        for index in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[index] ^= 0x10;
            let reason = if index < mark.len() {
                Unreadable::Mark
            } else {
                Unreadable::Damaged
            };
            assert_eq!(read(&changed), Err(reason), "{index}");
        }
        assert!(read(&[&bytes[..], b"x"].concat()).is_err());
    }
}
