//! How strips and fins are joined: what is known of a joint before anything is made with it.

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

/// What is known of a joint.
struct Facts {
    name: &'static str,
    words: &'static str,
    has_strips: bool,
    has_hubs_everywhere: bool,
    takes_remedies: bool,
}

impl Joint {
    /// All joints there are.
    pub const ALL: [Self; 3] = [Self::Lap, Self::Hinge, Self::Hub];

    const fn facts(self) -> Facts {
        match self {
            Self::Lap => Facts {
                name: "lap",
                words: "rigid strips, half-lapped where they cross",
                has_strips: true,
                has_hubs_everywhere: false,
                takes_remedies: false,
            },
            Self::Hinge => Facts {
                name: "hinge",
                words: "single fins on rods",
                has_strips: false,
                has_hubs_everywhere: false,
                takes_remedies: true,
            },
            Self::Hub => Facts {
                name: "hub",
                words: "single fins in slotted discs",
                has_strips: false,
                has_hubs_everywhere: true,
                takes_remedies: false,
            },
        }
    }

    /// As it is typed and written.
    pub const fn name(self) -> &'static str {
        self.facts().name
    }

    /// What is built, in words.
    pub const fn words(self) -> &'static str {
        self.facts().words
    }

    /// Whether fins are grouped into strips; else each is a body of its own.
    pub const fn has_strips(self) -> bool {
        self.facts().has_strips
    }

    /// Whether every node has a hub anyway.
    pub const fn has_hubs_everywhere(self) -> bool {
        self.facts().has_hubs_everywhere
    }

    /// Whether hubs on some nodes cure it where it is flexible.
    pub const fn takes_remedies(self) -> bool {
        self.facts().takes_remedies
    }
}
