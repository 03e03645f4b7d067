//! Numbers that name things, one type for each kind of thing.
//!
//! A number that names a node cannot be taken for one that names a face. Slices and
//! vectors are indexed by any of them: a table with one entry per node is asked by
//! [`NodeId`]. In files each is written as the bare number.

use serde::{Deserialize, Serialize};
use std::fmt::{Debug, Display, Formatter};
use std::ops::{Index, IndexMut};

/// Makes a type whose values name things of one kind, counted from 0.
macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[derive(Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(usize);

        impl $name {
            /// The thing at this place, counted from 0.
            pub const fn new(index: usize) -> Self {
                Self(index)
            }

            /// Its place, counted from 0.
            pub const fn index(self) -> usize {
                self.0
            }
        }

        impl From<usize> for $name {
            fn from(index: usize) -> Self {
                Self(index)
            }
        }

        impl Display for $name {
            fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
                Display::fmt(&self.0, f)
            }
        }

        impl Debug for $name {
            fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
                Debug::fmt(&self.0, f)
            }
        }

        impl<T> Index<$name> for [T] {
            type Output = T;

            fn index(&self, id: $name) -> &T {
                &self[id.0]
            }
        }

        impl<T> IndexMut<$name> for [T] {
            fn index_mut(&mut self, id: $name) -> &mut T {
                &mut self[id.0]
            }
        }

        impl<T> Index<$name> for Vec<T> {
            type Output = T;

            fn index(&self, id: $name) -> &T {
                &self[id.0]
            }
        }

        impl<T> IndexMut<$name> for Vec<T> {
            fn index_mut(&mut self, id: $name) -> &mut T {
                &mut self[id.0]
            }
        }
    };
}

id! {
    /// A node: a vertex of a mesh.
    NodeId
}

id! {
    /// A face of a mesh.
    FaceId
}

id! {
    /// An edge of a mesh.
    EdgeId
}

id! {
    /// A side of a face of a mesh, in the direction of the face.
    HalfEdge
}

id! {
    /// A strip of a structure.
    StripId
}

id! {
    /// A part of a job, in the order of assembly.
    PartId
}

/// A fin, by the two nodes between which it stands, the smaller number first. At most one
/// fin stands between two nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(transparent)]
pub struct FinId([NodeId; 2]);

impl FinId {
    /// The fin between two nodes, in whatever order.
    pub fn between(a: NodeId, b: NodeId) -> Self {
        Self([a.min(b), a.max(b)])
    }

    /// Its nodes, the smaller number first.
    pub const fn ends(self) -> [NodeId; 2] {
        self.0
    }

    /// Whether a node is one of its ends.
    pub fn ends_at(self, node: NodeId) -> bool {
        self.0.contains(&node)
    }
}

impl Display for FinId {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}-{}", self.0[0], self.0[1])
    }
}

impl From<[NodeId; 2]> for FinId {
    fn from([a, b]: [NodeId; 2]) -> Self {
        Self::between(a, b)
    }
}
