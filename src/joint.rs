//! How strips and fins are joined.

use serde::{Deserialize, Serialize};

/// How strips and fins are joined on the node axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Joint {
    /// Rigid strips, half-lapped where they cross.
    #[default]
    Lap,
    /// Single fins on rods.
    Hinge,
    /// Single fins in slotted discs.
    Hub,
}

impl Joint {
    /// As it is typed and written.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Lap => "lap",
            Self::Hinge => "hinge",
            Self::Hub => "hub",
        }
    }
}
