//! Serialization of sizes and attributes by serde; deserialization rejects unknown attributes.

use super::{Attributes, Size};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

#[derive(Serialize, Deserialize)]
#[serde(rename = "Size")]
struct SizeForm {
    columns: u16,
    rows: u16,
}

impl Serialize for Size {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { columns, rows } = *self;
        SizeForm { columns, rows }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Size {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        SizeForm::deserialize(deserializer).map(|SizeForm { columns, rows }| Self { columns, rows })
    }
}

// Stored as a number, because the bits of the constants never change. Unknown bits are an error.
impl Serialize for Attributes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.bits().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Attributes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let bits = u16::deserialize(deserializer)?;
        let attributes = Self::from_bits_truncate(bits);
        if attributes.bits() == bits { Ok(attributes) } else { Err(D::Error::custom("text attributes have nine bits")) }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
