//! Faces, from the order of lines around nodes alone.

use crate::design::quads::nodes::Net;

/// Faces and what they say.
pub(super) struct Faces {
    pub faces: Vec<Vec<usize>>,
    pub edges: usize,
    /// Faces away from the boundary that have not four sides.
    pub no_quads: usize,
}

/// A directed edge: a line from a port, or a piece of the boundary.
struct Dart {
    node: usize,
    back: usize,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Line,
    /// Along the boundary with the surface on the left, and against it.
    Along,
    Outside,
}

pub(super) fn faces(net: &Net, rings: &[Vec<usize>]) -> Faces {
    let line = |port: &crate::design::quads::nodes::Port| Dart {
        node: port.node,
        back: port.other,
        kind: Kind::Line,
    };
    let mut darts: Vec<Dart> = net.ports.iter().map(line).collect();
    let mut around: Vec<Vec<usize>> =
        net.nodes.iter().map(|knot| knot.ports.clone()).collect();
    for ring in rings {
        for (&from, &to) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            let (along, against) = (darts.len(), darts.len() + 1);
            darts.push(Dart { node: from, back: against, kind: Kind::Along });
            darts.push(Dart { node: to, back: along, kind: Kind::Outside });
            // Counter-clockwise: the boundary ahead, what leads inside, the boundary behind.
            around[from].insert(0, along);
            around[to].push(against);
        }
    }
    let mut place = vec![0; darts.len()];
    for list in &around {
        list.iter().enumerate().for_each(|(k, &dart)| place[dart] = k);
    }
    let mut found = Faces { faces: Vec::new(), edges: darts.len() / 2, no_quads: 0 };
    let mut seen = vec![false; darts.len()];
    for start in 0..darts.len() {
        let (mut face, mut dart) = (Vec::new(), start);
        let (mut rim, mut outside) = (false, false);
        while !std::mem::replace(&mut seen[dart], true) {
            face.push(darts[dart].node);
            rim |= darts[dart].kind == Kind::Along;
            outside |= darts[dart].kind == Kind::Outside;
            // The sharpest turn to the left: the one before the way back.
            let back = darts[dart].back;
            let list = &around[darts[back].node];
            dart = list[(place[back] + list.len() - 1) % list.len()];
        }
        if face.is_empty() || outside {
            continue;
        }
        found.no_quads += usize::from(!rim && face.len() != 4);
        found.faces.push(face);
    }
    found
}
