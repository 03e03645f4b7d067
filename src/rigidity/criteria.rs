//! What is asked about a model: play, limit, and how the paper's figures are made.

use crate::rigidity::finding::RigidityFinding;

/// What a structure may sway.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SwayLimit {
    /// So many mm.
    Length(f64),
    /// A share of the distance to the nearest support: 1/50 for `L/50`.
    Share(f64),
}

impl SwayLimit {
    /// The limit over a span, both in mm.
    pub fn of(self, span: f64) -> f64 {
        match self {
            Self::Length(length) => length,
            Self::Share(share) => share * span,
        }
    }
}

impl std::str::FromStr for SwayLimit {
    type Err = RigidityFinding;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let wrong = || RigidityFinding::BadLimit { text: text.to_owned() };
        let number = |text: &str| {
            let number = text.trim().parse::<f64>().map_err(|_| wrong())?;
            if number.is_finite() && number > 0.0 { Ok(number) } else { Err(wrong()) }
        };
        match text.trim().strip_prefix("L/") {
            Some(parts) => Ok(Self::Share(1.0 / number(parts)?)),
            None => Ok(Self::Length(number(text)?)),
        }
    }
}

/// What is asked about a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Criteria {
    /// Play: how far a contact may leave its pin, mm.
    pub play_mm: f64,
    /// What a node may sway.
    pub limit: SwayLimit,
    /// How many of the least resisted motions to look at.
    pub modes: usize,
    /// How the paper's matrix compares bodies.
    pub pairing: Pairing,
    /// Scaled lengths over lengths in the paper's figures.
    pub scale: f64,
}

/// Which bodies on one axis are compared with which.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Pairing {
    /// Each with the mean of all: the rod of the hinge.
    #[default]
    Pin,
    /// Each with the next.
    Chain,
    /// Each with the first.
    Star,
    /// Each with the next, the last with the first.
    Cyclic,
    /// Each with every other.
    All,
}

impl Pairing {
    /// As it is typed and written.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pin => "pin",
            Self::Chain => "chain",
            Self::Star => "star",
            Self::Cyclic => "cyclic",
            Self::All => "all",
        }
    }

    /// Differences to take among `count` bodies: their shares in each.
    pub(super) fn differences(self, count: usize) -> Vec<Vec<(usize, f64)>> {
        let pair = |i: usize, j: usize| vec![(i, 1.0), (j, -1.0)];
        match self {
            _ if count < 2 => Vec::new(),
            Self::Pin => {
                let mean = 1.0 / count as f64;
                let share = |i: usize, j: usize| if i == j { 1.0 - mean } else { -mean };
                let row = |i: usize| (0..count).map(|j| (j, share(i, j))).collect();
                (0..count).map(row).collect()
            }
            Self::Chain => (1..count).map(|j| pair(j - 1, j)).collect(),
            Self::Star => (1..count).map(|j| pair(0, j)).collect(),
            Self::Cyclic => (0..count).map(|j| pair(j, (j + 1) % count)).collect(),
            Self::All => {
                let firsts = 0..count;
                firsts.flat_map(|i| (i + 1..count).map(move |j| pair(i, j))).collect()
            }
        }
    }
}
