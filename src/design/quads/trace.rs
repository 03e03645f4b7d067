//! Lines followed from port to port.

use crate::design::map::{UNIT, cross};
use crate::design::quads::Broken;
use crate::design::quads::chart::{Charts, minus, way};
use crate::design::quads::nodes::{NONE, Net};
use crate::design::surface::previous;

/// Where a line from a port ends at the boundary: the edge, and how far along it, as a
/// fraction.
pub(super) struct Stop {
    pub port: usize,
    pub side: usize,
    pub share: [i128; 2],
}

/// A line on its way: where it began, in the coordinates of the triangle where it is.
#[derive(Clone, Copy)]
struct Line {
    triangle: usize,
    from: [i64; 2],
    way: i32,
}

enum End {
    Port(usize),
    Boundary(usize, [i128; 2]),
}

/// Pairs all ports, and returns where lines end at the boundary.
pub(super) fn pair(charts: &Charts, net: &mut Net) -> Result<Vec<Stop>, Broken> {
    let mut stops = Vec::new();
    let mut lost = (0, 0);
    for port in 0..net.ports.len() {
        let from = net.ports[port];
        let line = Line { triangle: from.triangle, from: from.at, way: from.way };
        match follow(charts, net, line) {
            Some(End::Port(other)) => net.ports[port].other = other,
            Some(End::Boundary(side, share)) => stops.push(Stop { port, side, share }),
            None => lost = (lost.0 + 1, from.triangle),
        }
    }
    for port in 0..net.ports.len() {
        let other = net.ports[port].other;
        if other != NONE && net.ports[other].other != port {
            lost = (lost.0 + 1, net.ports[port].triangle);
        }
    }
    match lost {
        (0, _) => Ok(stops),
        (count, triangle) => Err(Broken::Lost { count, triangle }),
    }
}

fn follow(charts: &Charts, net: &Net, mut line: Line) -> Option<End> {
    line = started(charts, line);
    // A line of one cell crosses no triangle twice.
    for _ in 0..=charts.surface.triangles.len() {
        let d = way(line.way);
        let goal = [line.from[0] + UNIT * d[0], line.from[1] + UNIT * d[1]];
        let sides = charts.sides(line.triangle, goal);
        if sides.iter().all(|&side| side >= 0) {
            return arrived(charts, net, &line, goal, sides).map(End::Port);
        }
        let corners = charts.corners(line.triangle);
        let left = corners.map(|at| cross(d, minus(at, line.from)));
        // A vertex on the line, where an edge is followed, counts as to the left.
        let exit = (0..3).find(|&k| left[k] < 0 && left[(k + 1) % 3] >= 0)?;
        let side = 3 * line.triangle + exit;
        if charts.surface.is_boundary(side) {
            let (from, to) = (left[exit], left[(exit + 1) % 3]);
            return Some(End::Boundary(side, [-from, to - from]));
        }
        line = crossed(charts, line, side)?;
    }
    None
}

/// A line that begins on a side and leads out of its triangle begins beyond; one along a
/// side is taken to run a little to the right of it.
fn started(charts: &Charts, line: Line) -> Line {
    let sides = charts.sides(line.triangle, line.from);
    let (d, on) = (way(line.way), (0..3).filter(|&k| sides[k] == 0));
    let leads_out = |&side: &usize| {
        let along = charts.along(side);
        let turn = cross(along, d);
        let same_way = along[0].signum() * d[0] + along[1].signum() * d[1] > 0;
        turn < 0 || (turn == 0 && same_way)
    };
    let mut out = on.map(|k| 3 * line.triangle + k).filter(leads_out);
    match (out.next(), out.next()) {
        (Some(side), None) => crossed(charts, line, side).unwrap_or(line),
        _ => line,
    }
}

fn crossed(charts: &Charts, line: Line, side: usize) -> Option<Line> {
    let (triangle, quarters) = charts.over(side)?;
    let from = charts.beyond(side, line.from);
    Some(Line { triangle, from, way: line.way + quarters })
}

/// The port by which a line comes in.
fn arrived(
    charts: &Charts,
    net: &Net,
    line: &Line,
    goal: [i64; 2],
    sides: [i128; 3],
) -> Option<usize> {
    let back = line.way + 2;
    let on: Vec<usize> = (0..3).filter(|&k| sides[k] == 0).collect();
    if on.len() > 1 {
        let corner = (0..3)
            .map(|k| 3 * line.triangle + k)
            .find(|&corner| charts.at(corner) == goal)?;
        let node = net.at_vertex[charts.surface.tail(corner)]?;
        // Along the last side of a sector the port belongs to the next.
        return net.port(node, line.triangle, back).or_else(|| {
            let (triangle, quarters) = charts.over(previous(corner))?;
            net.port(node, triangle, back + quarters)
        });
    }
    let (mut triangle, mut at, mut back) = (line.triangle, goal, back);
    if let Some(side) = on.first().map(|k| 3 * triangle + k)
        && let Some((beyond, quarters)) = charts.over(side)
        && beyond < triangle
    {
        (triangle, at, back) = (beyond, charts.beyond(side, goal), back + quarters);
    }
    let (_, node) = net.inside[triangle].iter().find(|inside| inside.0 == at)?;
    net.port(*node, triangle, back)
}
