//! Units of length at the border; inside everything is millimetres.

use serde::{Deserialize, Serialize};

/// A unit that files and `--units` may name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Unit {
    /// mm
    #[serde(rename = "mm")]
    Millimetre,
    /// cm
    #[serde(rename = "cm")]
    Centimetre,
    /// m
    #[serde(rename = "m")]
    Metre,
    /// in
    #[serde(rename = "in")]
    Inch,
    /// ft
    #[serde(rename = "ft")]
    Foot,
}

impl Unit {
    /// How many millimetres one of it is.
    pub const fn millimetres(self) -> f64 {
        match self {
            Self::Millimetre => 1.0,
            Self::Centimetre => 10.0,
            Self::Metre => 1000.0,
            Self::Inch => 25.4,
            Self::Foot => 304.8,
        }
    }
}

impl std::str::FromStr for Unit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "mm" => Ok(Self::Millimetre),
            "cm" => Ok(Self::Centimetre),
            "m" => Ok(Self::Metre),
            "in" => Ok(Self::Inch),
            "ft" => Ok(Self::Foot),
            other => Err(format!("\"{other}\" is no unit; use mm, cm, m, in or ft")),
        }
    }
}
