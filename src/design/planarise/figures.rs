//! What was reached, and at what price, in numbers.

use serde::{Serialize, Serializer};

/// Planarity of many fins, each as a share of its diameter (docs/formulas.md 3). Written in
/// percent.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// The worst.
    #[serde(rename = "worst_percent", serialize_with = "percent")]
    pub worst: f64,
    /// Nineteen of twenty are no worse.
    #[serde(rename = "p95_percent", serialize_with = "percent")]
    pub p95: f64,
    /// The mean.
    #[serde(rename = "mean_percent", serialize_with = "percent")]
    pub mean: f64,
}

fn percent<S: Serializer>(share: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_f64(share * 100.0)
}

fn degrees<S: Serializer>(radians: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_f64(radians.to_degrees())
}

impl Spread {
    /// Of these; all zero if there are none.
    pub fn of(shares: impl Iterator<Item = f64>) -> Self {
        let mut shares: Vec<f64> = shares.collect();
        shares.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let place = (share * shares.len() as f64) as usize;
            shares.get(place.min(shares.len().saturating_sub(1))).copied().unwrap_or(0.0)
        };
        let mean = shares.iter().sum::<f64>() / (shares.len().max(1) as f64);
        Self { worst: at(1.0), p95: at(0.95), mean }
    }
}

/// What was reached, and at what price. Lengths in mm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Figures {
    /// How many fins.
    pub fins: usize,
    /// Their median length.
    #[serde(rename = "fin_length_mm")]
    pub fin_length: f64,
    /// Planarity before.
    pub before: Spread,
    /// Planarity after.
    pub after: Spread,
    /// The median and the largest move of a node.
    #[serde(rename = "moves_mm")]
    pub moves: [f64; 2],
    /// The median and the largest turn of an axis, radians; written in degrees.
    #[serde(rename = "median_turn_deg", serialize_with = "degrees")]
    pub median_turn: f64,
    /// The largest turn of an axis, radians.
    #[serde(rename = "largest_turn_deg", serialize_with = "degrees")]
    pub largest_turn: f64,
    /// The largest distance between the given surface and the new one, sampled both ways
    /// at nodes and in the middle of edges and faces.
    #[serde(rename = "distance_mm")]
    pub distance: f64,
    /// The largest angle between an axis and the normal of the new surface, radians.
    #[serde(rename = "largest_tilt_deg", serialize_with = "degrees")]
    pub largest_tilt: f64,
    /// Faces that were turned over or folded.
    pub reversed_faces: usize,
}
