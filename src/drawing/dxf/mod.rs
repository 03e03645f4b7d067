//! DXF as our exporter and CAD programs write it: R12 to R2018.
//!
//! Group codes by Autodesk's "DXF Reference": 0 begins an entity, 8 names its layer, 10
//! and 20 are a point, 42 a bulge, 70 flags, 210 to 230 the extrusion direction, 67 paper
//! space, 60 invisibility. Only model space is read; blocks are drawn where they are
//! inserted; what stands on layers that are off or frozen is counted, not drawn.

mod entity;
mod tags;
#[cfg(test)]
mod tests;

use crate::drawing::transform::transformed;
use crate::drawing::{Curve, Drawing, DrawingError, Reading, Source};
use crate::drawing::{chain, is_cut, layer_named};
use crate::geometry::{Motion, Point2, Vector2, Vertex};
use crate::tolerance::{ARC_SAGITTA_MM, JOINED_MM};
use entity::{Drawn, Entity, entities};
use nalgebra::Matrix3;
use std::collections::{BTreeMap, BTreeSet};
use tags::{Tag, tags};

/// Reads the lines of a DXF file, in millimetres.
///
/// # Errors
/// [`DrawingError`] if the bytes are no DXF, or a number in them is none.
pub fn read_dxf(bytes: &[u8], reading: &Reading) -> Result<Drawing, DrawingError> {
    let tags = tags(bytes)?;
    let unit = reading.millimetres.or(unit(&tags));
    let layers = entities(section(&tags, "TABLES"));
    let is_layer = |layer: &&Entity| layer.kind() == "LAYER";
    // A layer is off if its colour is negative, frozen by a flag.
    let is_off = |layer: &&Entity| layer.number(62) < 0.0 || layer.flags() & 1 == 1;
    let off = layers.iter().filter(is_layer).filter(is_off);
    let mut reader = Reader {
        reading,
        drawing: Drawing { says_unit: unit.is_some(), ..Drawing::default() },
        off: off.filter_map(|layer| layer.text(2)).map(str::to_lowercase).collect(),
        blocks: blocks(&tags),
        copied: 0,
    };
    let scale = unit.unwrap_or(1.0);
    let matrix = Matrix3::new(scale, 0.0, 0.0, 0.0, scale, 0.0, 0.0, 0.0, 1.0);
    let model = Place { matrix, layer: "0", depth: 0 };
    reader.draw(&entities(section(&tags, "ENTITIES")), &model);
    Ok(chain::joined(reader.drawing, JOINED_MM, |c| is_cut(c.layer).then_some(c.layer)))
}

/// The tags of a section.
fn section<'a>(tags: &'a [Tag<'a>], name: &str) -> &'a [Tag<'a>] {
    let Some(start) = tags.iter().position(|tag| tag.0 == 2 && tag.1 == name) else {
        return &[];
    };
    let tags = &tags[start + 1..];
    let end = tags.iter().position(|tag| tag.0 == 0 && tag.1 == "ENDSEC");
    &tags[..end.unwrap_or(tags.len())]
}

/// Millimetres per drawing unit by the codes of `$INSUNITS`; 0 where there is no unit.
const UNITS: [f64; 25] = [
    0.0,
    25.4,
    304.8,
    1_609_344.0,
    1.0,
    10.0,
    1000.0,
    1_000_000.0,
    0.000_025_4,
    0.0254,
    914.4,
    0.000_000_1,
    0.000_001,
    0.001,
    100.0,
    10_000.0,
    100_000.0,
    0.0,
    0.0,
    0.0,
    0.0,
    1_200_000.0 / 3937.0,
    100_000.0 / 3937.0,
    3_600_000.0 / 3937.0,
    6_336_000_000.0 / 3937.0,
];

/// Millimetres per drawing unit, if the header says so.
fn unit(tags: &[Tag]) -> Option<f64> {
    let at = tags.iter().position(|tag| tag.0 == 9 && tag.1 == "$INSUNITS")?;
    let code: usize = tags.get(at + 1)?.1.parse().ok()?;
    UNITS.get(code).copied().filter(|mm| *mm > 0.0)
}

/// Entities that are drawn wherever a block is inserted.
struct Block<'a> {
    base: Point2,
    entities: Vec<Entity<'a>>,
}

/// The blocks by their names in lower case.
fn blocks<'a>(tags: &'a [Tag<'a>]) -> BTreeMap<String, Block<'a>> {
    let mut blocks = BTreeMap::new();
    let mut open: Option<(String, Block)> = None;
    for entity in entities(section(tags, "BLOCKS")) {
        match entity.kind() {
            "BLOCK" => {
                let name = entity.text(2).unwrap_or("").to_lowercase();
                let base = entity.point(10, 20);
                open = Some((name, Block { base, entities: Vec::new() }));
            }
            "ENDBLK" => blocks.extend(open.take()),
            _ => {
                if let Some((_, block)) = &mut open {
                    block.entities.push(entity);
                }
            }
        }
    }
    blocks
}

/// Blocks in blocks are followed so far.
const DEEPEST: usize = 32;
/// Entities and corners drawn by INSERT, at most: blocks of blocks grow without bound.
const MOST_COPIED: usize = 4_000_000;

struct Reader<'a> {
    reading: &'a Reading<'a>,
    drawing: Drawing,
    /// Layers that are off or frozen, in lower case.
    off: BTreeSet<String>,
    blocks: BTreeMap<String, Block<'a>>,
    /// Entities and corners drawn by INSERT so far.
    copied: usize,
}

/// Where entities stand.
#[derive(Clone, Copy)]
struct Place<'a> {
    /// From their coordinates to millimetres.
    matrix: Matrix3<f64>,
    /// The layer that what is drawn on layer 0 comes to lie on.
    layer: &'a str,
    depth: usize,
}

impl<'a> Reader<'a> {
    fn draw(&mut self, entities: &[Entity<'a>], place: &Place<'a>) {
        let mut k = 0;
        while let Some(entity) = entities.get(k) {
            k += 1;
            let vertices = &entities[k..];
            let is_vertex = |entity: &&Entity| entity.kind() == "VERTEX";
            let count = match entity.kind() {
                "POLYLINE" => vertices.iter().take_while(is_vertex).count(),
                _ => 0,
            };
            self.add(entity, &vertices[..count], place);
            k += count;
        }
    }

    fn add(&mut self, entity: &Entity<'a>, vertices: &[Entity<'a>], place: &Place<'a>) {
        let own = entity.text(8).unwrap_or("0");
        let name = if own == "0" { place.layer } else { own };
        if entity.number(67) > 0.0 {
            self.drawing.paper += 1;
            return;
        }
        if entity.number(60) > 0.0 || self.off.contains(&name.to_lowercase()) {
            let lines =
                usize::from(!matches!(entity.kind(), "SEQEND" | "ATTRIB" | "POINT"));
            *self.drawing.hidden.entry(decoded(name)).or_default() += lines;
            return;
        }
        self.copied += if place.depth > 0 { 1 + vertices.len() } else { 0 };
        let layer = layer_named(self.reading.known, name).unwrap_or("");
        if entity.kind() == "INSERT" {
            let name = entity.text(2).unwrap_or("").to_lowercase();
            if place.depth >= DEEPEST || self.copied > MOST_COPIED {
                return self.unread("INSERT too deep or too often", layer);
            }
            let Some(facing) = entity.facing() else {
                return self.unread("tilted INSERT", layer);
            };
            let Some(block) = self.blocks.remove(&name) else {
                return self.unread("INSERT", layer);
            };
            self.insert(entity, &block, facing, place);
            self.blocks.insert(name, block);
            return;
        }
        let linear = place.matrix.fixed_view::<2, 2>(0, 0).determinant().abs().sqrt();
        let (corners, closed) = match entity.drawn(vertices, ARC_SAGITTA_MM / linear) {
            Drawn::Line(corners, closed) => (corners, closed),
            Drawn::Nothing => return,
            Drawn::Unread => return self.unread(entity.kind(), layer),
            Drawn::Tilted => {
                return self.unread(&format!("tilted {}", entity.kind()), layer);
            }
        };
        let mirrored =
            if entity.has_plane() { entity.facing().unwrap_or(1.0) } else { 1.0 };
        let matrix = place.matrix * mirroring(mirrored);
        let source = Source { name: decoded(name), rgb: None };
        let corners = transformed(&corners, closed, matrix);
        self.copied += if place.depth > 0 { corners.len() } else { 0 };
        self.drawing.curves.extend(plain(layer, source, corners, closed));
    }

    fn unread(&mut self, kind: &str, layer: &'static str) {
        *self.drawing.unread.entry((kind.to_owned(), layer)).or_default() += 1;
    }

    /// Draws a block in all rows and columns of its insertion. While it is drawn it is not
    /// among the blocks, so that none can contain itself.
    fn insert(
        &mut self,
        entity: &Entity<'a>,
        block: &Block<'a>,
        facing: f64,
        place: &Place<'a>,
    ) {
        let own = entity.text(8).unwrap_or("0");
        let layer = if own == "0" { place.layer } else { own };
        let [sx, sy] = [41, 42].map(|code| entity.given(code).unwrap_or(1.0));
        let count = |code| (entity.number(code).max(1.0) as usize).min(MOST_COPIED);
        let turn = Motion::rotation(entity.number(50).to_radians());
        let at = entity.point(10, 20).coords;
        let base = Matrix3::new_translation(&-block.base.coords);
        let [x, y] =
            [Vector2::new(sx, 0.0), Vector2::new(0.0, sy)].map(|v| turn.rotate(v));
        for row in 0..count(71) {
            for column in 0..count(70) {
                if self.copied > MOST_COPIED {
                    return;
                }
                let spaced = Vector2::new(
                    entity.number(44) * column as f64,
                    entity.number(45) * row as f64,
                );
                let to = at + turn.rotate(spaced);
                let own = Matrix3::new(x.x, y.x, to.x, x.y, y.y, to.y, 0.0, 0.0, 1.0);
                let matrix = place.matrix * mirroring(facing) * own * base;
                self.copied += 1;
                self.draw(
                    &block.entities,
                    &Place { matrix, layer, depth: place.depth + 1 },
                );
            }
        }
    }
}

fn mirroring(facing: f64) -> Matrix3<f64> {
    Matrix3::new(facing, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
}

/// A name with its `\U+00E4` as letters.
fn decoded(name: &str) -> String {
    let mut parts = name.split("\\U+");
    let mut decoded = parts.next().unwrap_or("").to_owned();
    for part in parts {
        let code = part.get(..4).and_then(|hex| u32::from_str_radix(hex, 16).ok());
        match code.and_then(char::from_u32) {
            Some(letter) => {
                decoded.push(letter);
                decoded.push_str(&part[4..]);
            }
            None => decoded.push_str(part),
        }
    }
    decoded
}

/// The curve without corners that repeat the one before; `None` if nothing is left.
fn plain(
    layer: &'static str,
    source: Source,
    mut corners: Vec<Vertex>,
    closed: bool,
) -> Option<Curve> {
    corners.dedup_by(|b, a| {
        let repeats = a.point == b.point;
        if repeats {
            a.bulge = b.bulge;
        }
        repeats
    });
    let (first, last) = (corners.first()?.point, corners.last()?.point);
    let is_circle = corners.len() == 2 && closed;
    let mut closed = closed;
    if corners.len() > 2 && first == last {
        corners.pop();
        closed = true;
    }
    let is_line = corners.len() > 2 || is_circle || (corners.len() == 2 && !closed);
    is_line.then_some(Curve { layer, source, vertices: corners, closed })
}
