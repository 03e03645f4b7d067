//! Points as pairs of numbers.

use crate::geometry::Point2;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Points, lists of them and lists of those.
pub(super) trait Points: Sized {
    /// The same in numbers.
    type Pairs: Serialize + DeserializeOwned;
    fn pairs(&self) -> Self::Pairs;
    fn of(pairs: Self::Pairs) -> Self;
}

impl Points for Point2 {
    type Pairs = [f64; 2];

    fn pairs(&self) -> [f64; 2] {
        [self.x, self.y]
    }

    fn of(pair: [f64; 2]) -> Self {
        pair.into()
    }
}

impl<P: Points> Points for Vec<P> {
    type Pairs = Vec<P::Pairs>;

    fn pairs(&self) -> Self::Pairs {
        self.iter().map(P::pairs).collect()
    }

    fn of(pairs: Self::Pairs) -> Self {
        pairs.into_iter().map(P::of).collect()
    }
}

pub(super) fn serialize<P: Points, S: Serializer>(
    points: &P,
    to: S,
) -> Result<S::Ok, S::Error> {
    points.pairs().serialize(to)
}

pub(super) fn deserialize<'de, P: Points, D: Deserializer<'de>>(
    from: D,
) -> Result<P, D::Error> {
    P::Pairs::deserialize(from).map(P::of)
}
