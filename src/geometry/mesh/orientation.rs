//! Whether the faces look to one side, and which would have to be turned round.

use crate::geometry::mesh::Mesh;
use crate::ids::{EdgeId, FaceId};
use std::collections::VecDeque;
use thiserror::Error;

/// The faces have one side only, as those of a Moebius strip: walking from face to face and
/// turning each to agree with the one before comes back to one that does not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("faces {} and {} cannot be turned to agree", .faces[0], .faces[1])]
pub struct OneSided {
    /// The neighbours that cannot agree.
    pub faces: [FaceId; 2],
}

impl Mesh {
    /// The two faces of an inner edge and whether both run the same way along it, so that
    /// one of them is turned round; none for an edge of one face or of more than two.
    pub fn neighbours(&self, edge: EdgeId) -> Option<([FaceId; 2], bool)> {
        let &[a, b] = self.half_edges_of(edge) else { return None };
        let faces = [self.face(a), self.face(b)];
        (faces[0] != faces[1]).then(|| (faces, self.tail(a) == self.tail(b)))
    }

    /// The faces to be turned round so that all neighbours agree: of each component, the
    /// smaller share. None of an oriented mesh.
    ///
    /// # Errors
    /// [`OneSided`] if there are no such faces.
    pub fn turned_faces(&self) -> Result<Vec<FaceId>, OneSided> {
        let mut turned = vec![None; self.face_count()];
        let mut wrong = Vec::new();
        for start in self.faces() {
            if turned[start].is_none() {
                wrong.extend(self.turned_in_component(start, &mut turned)?);
            }
        }
        Ok(wrong)
    }

    fn turned_in_component(
        &self,
        start: FaceId,
        turned: &mut [Option<bool>],
    ) -> Result<Vec<FaceId>, OneSided> {
        let mut component = Vec::new();
        let mut queue = VecDeque::from([start]);
        turned[start] = Some(false);
        while let Some(face) = queue.pop_front() {
            component.push(face);
            for (other, same_way) in self.beside(face) {
                let wanted = turned[face].map(|turned| turned != same_way);
                if turned[other].is_none() {
                    turned[other] = wanted;
                    queue.push_back(other);
                } else if turned[other] != wanted {
                    let faces = [face.min(other), face.max(other)];
                    return Err(OneSided { faces });
                }
            }
        }
        component.sort_unstable();
        let (with, against): (Vec<FaceId>, Vec<FaceId>) =
            component.into_iter().partition(|&face| turned[face] == Some(false));
        Ok(if against.len() <= with.len() { against } else { with })
    }

    /// The neighbours of a face, ordered by their edges' nodes, so that it does not matter
    /// at which corner a face begins.
    fn beside(&self, face: FaceId) -> Vec<(FaceId, bool)> {
        let mut edges: Vec<EdgeId> =
            self.half_edges_around(face).map(|side| self.edge(side)).collect();
        edges.sort_by_key(|&edge| self.ends(edge));
        let over = edges.into_iter().filter_map(|edge| self.neighbours(edge));
        let other = |faces: [FaceId; 2]| faces[usize::from(faces[0] == face)];
        over.map(|(faces, same_way)| (other(faces), same_way)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strip_joined_with_a_half_turn_has_one_side() {
        let count = 8;
        let mut faces: Vec<[usize; 4]> =
            (0..count - 1).map(|k| [2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1]).collect();
        faces.push([2 * count - 2, 1, 0, 2 * count - 1]);
        let mesh = Mesh::new(2 * count, &faces).unwrap();
        assert!(mesh.turned_faces().is_err());
        assert_eq!(mesh.euler_characteristic(), 0);
    }

    #[test]
    fn the_odd_face_out_is_the_one_to_turn() {
        let faces = [[0, 1, 4, 3], [1, 4, 5, 2], [3, 4, 7, 6], [4, 5, 8, 7]];
        let mesh = Mesh::new(9, &faces).unwrap();
        assert_eq!(mesh.turned_faces().unwrap(), [FaceId::new(1)]);
        let wrong = mesh.edges().filter_map(|edge| mesh.neighbours(edge));
        assert_eq!(wrong.filter(|&(_, same_way)| same_way).count(), 2);
    }
}
