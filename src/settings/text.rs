//! The text form of culling settings, for serde.

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::{Deserialize, Deserializer, Serializer};

use super::{DirectionSet, Interest, ViewCone};

impl<'de> Deserialize<'de> for Interest {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ListOrCone;
        impl<'de> serde::de::Visitor<'de> for ListOrCone {
            type Value = Interest;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a list of body indices or a view cone")
            }

            fn visit_seq<A: serde::de::SeqAccess<'de>>(
                self,
                list: A,
            ) -> Result<Interest, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(Interest::Bodies)
            }

            fn visit_map<A: serde::de::MapAccess<'de>>(
                self,
                cone: A,
            ) -> Result<Interest, A::Error> {
                ViewCone::deserialize(MapAccessDeserializer::new(cone)).map(Interest::Cone)
            }
        }
        deserializer.deserialize_any(ListOrCone)
    }
}

pub(super) fn read_k<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DirectionSet, D::Error> {
    let k = i64::deserialize(deserializer)?;
    k.to_string().parse().map_err(|_| {
        serde::de::Error::custom(format_args!(
            "no or-DOP has k = `{k}`, expected one of `6`, `14`, `18`, `26`"
        ))
    })
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "the signature is serde's")]
pub(super) fn write_k<S: Serializer>(set: &DirectionSet, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_u64(set.k() as u64)
}
