//! Inner edges between two vertices of the boundary, or of lines that fins follow, are
//! split: a triangle with all three corners on one line would have no area in the map.

use crate::design::surface::Surface;
use crate::geometry::Vector3;

impl Surface {
    /// The same with every inner edge split whose both ends lie on the boundary or on a
    /// line.
    pub(super) fn without_ears(self) -> Self {
        let mut on_line: Vec<bool> =
            (0..self.positions.len()).map(|vertex| self.on_boundary(vertex)).collect();
        self.followed.iter().flatten().for_each(|&vertex| on_line[vertex] = true);
        let ears: Vec<usize> = (0..self.side_count())
            .filter(|&side| {
                let ends = [self.tail(side), self.tip(side)];
                self.twin(side).is_some_and(|twin| side < twin)
                    && ends.iter().all(|&vertex| on_line[vertex])
                    && !self.is_followed(side)
            })
            .collect();
        if ears.is_empty() {
            return self;
        }
        let mut middle = vec![None; self.side_count()];
        let (mut positions, mut axes) = (self.positions.clone(), self.axes.clone());
        for &side in &ears {
            let (a, b) = (self.tail(side), self.tip(side));
            middle[side] = Some(positions.len());
            self.twin(side).into_iter().for_each(|twin| middle[twin] = middle[side]);
            positions.push(nalgebra::center(&positions[a], &positions[b]));
            if let Some(axes) = &mut axes {
                let sum: Vector3 = axes[a] + axes[b];
                axes.push(sum.try_normalize(0.0).unwrap_or(axes[a]));
            }
        }
        let split = |triangle: usize| {
            let middles = [0, 1, 2].map(|k| middle[3 * triangle + k]);
            split(self.triangles[triangle], middles)
        };
        let triangles = (0..self.triangles.len()).flat_map(split).collect();
        // New vertices lie inside, but an ear may have had both its inner sides split.
        let lines = self.followed;
        Self::new(positions, triangles, axes).with_lines(lines)
    }
}

/// A triangle whose `k`-th side, from corner `k`, has a vertex in its middle, in pieces.
fn split(corners: [usize; 3], middles: [Option<usize>; 3]) -> Vec<[usize; 3]> {
    let turned = |k: usize| [0, 1, 2].map(|i| (i + k) % 3);
    let count = middles.iter().flatten().count();
    // Turn it so that the first side is split and, of two, the second as well.
    let first = (0..3).find(|&k| {
        let [a, b, _] = turned(k);
        middles[a].is_some() && (count != 2 || middles[b].is_some())
    });
    let Some(first) = first else { return vec![corners] };
    let [a, b, c] = turned(first).map(|k| corners[k]);
    let [Some(ab), bc, ca] = turned(first).map(|k| middles[k]) else {
        return vec![corners];
    };
    match (bc, ca) {
        (Some(bc), Some(ca)) => {
            vec![[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        }
        (Some(bc), None) => vec![[b, bc, ab], [a, ab, bc], [a, bc, c]],
        _ => vec![[a, ab, c], [ab, b, c]],
    }
}
