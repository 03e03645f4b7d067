//! Numbers that name things, one type for each kind of thing.
//!
//! A number that names a node cannot be taken for one that names a face. Slices and
//! vectors are indexed by any of them: a table with one entry per node is asked by
//! [`NodeId`]. In files each is written as the bare number.

use serde::{Deserialize, Serialize};
use std::fmt::{Display, Formatter};
use std::ops::{Index, IndexMut};

/// Makes a type whose values name things of one kind, counted from 0.
macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
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
