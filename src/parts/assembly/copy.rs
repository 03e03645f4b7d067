//! Where the copies of a connector's plate sit in space.

use crate::parts::connector::Connector;
use crate::parts::hinge::plate::Hinge;
use crate::parts::hub::dimensions::Hub;

/// One plate of a node, placed across its axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Copy {
    /// Height of its middle along the axis, from the base mesh, mm.
    pub height: f64,
    /// Turn of the part about the axis, counter-clockwise from the first fin, radians.
    pub bearing: f64,
    /// The fins it holds, by their place around the node.
    pub holds: Vec<usize>,
}

/// All plates of a node from below.
pub fn copies(connector: &Connector) -> Vec<Copy> {
    match connector {
        Connector::Hub(hub) => discs(hub),
        Connector::Hinge(hinge) => eyes(hinge),
    }
}

fn discs(hub: &Hub) -> Vec<Copy> {
    let middles =
        [hub.faces[0] + hub.thickness / 2.0, hub.faces[1] - hub.thickness / 2.0];
    let holds: Vec<usize> = (0..hub.around.spokes.len()).collect();
    middles.map(|height| Copy { height, bearing: 0.0, holds: holds.clone() }).to_vec()
}

fn eyes(hinge: &Hinge) -> Vec<Copy> {
    let stacks = [0, 1].into_iter();
    let eyes = stacks.flat_map(|stack| {
        let spokes = hinge.around.spokes.iter().zip(&hinge.levels).enumerate();
        spokes.map(move |(place, (spoke, levels))| Copy {
            height: levels[stack],
            bearing: spoke.bearing,
            holds: vec![place],
        })
    });
    eyes.collect()
}
