//! DXF R12, the oldest and most widely read: polylines with bulges and nothing else.
//!
//! Written by hand because the strict readers refuse what the libraries write; see
//! Autodesk's "DXF Reference", group codes in numerical order.

use std::fmt::Display;

use super::arcs::is_arc;
use super::number::{bulge, length};
use super::{LAYERS, Layer};
use crate::geometry::Point2;
use crate::sheets::{Path, Sheet};

/// The sheet as DXF R12 (AC1009) in millimetres.
pub fn dxf(sheet: &Sheet) -> Vec<u8> {
    let mut tags = Tags(String::new());
    header(&mut tags, sheet);
    tables(&mut tags);
    tags.tag(0, "SECTION").tag(2, "ENTITIES");
    for layer in &LAYERS {
        for path in layer.paths(sheet) {
            polyline(&mut tags, layer, path);
        }
    }
    tags.tag(0, "ENDSEC").tag(0, "EOF");
    tags.0.into_bytes()
}

/// Pairs of group code and value, a line each.
struct Tags(String);

impl Tags {
    fn tag(&mut self, code: u16, value: impl Display) -> &mut Self {
        self.0.push_str(&format!("{code:>3}\n{value}\n"));
        self
    }

    fn point(&mut self, point: Point2) -> &mut Self {
        self.tag(10, length(point.x)).tag(20, length(point.y)).tag(30, 0)
    }
}

fn header(tags: &mut Tags, sheet: &Sheet) {
    let corner = Point2::new(sheet.width, sheet.height);
    tags.tag(0, "SECTION").tag(2, "HEADER");
    tags.tag(9, "$ACADVER").tag(1, "AC1009");
    // Both say millimetres; R12 proper knows neither, but its readers look for them:
    // most for $INSUNITS, Inkscape for $MEASUREMENT.
    tags.tag(9, "$INSUNITS").tag(70, 4);
    tags.tag(9, "$MEASUREMENT").tag(70, 1);
    tags.tag(9, "$EXTMIN").point(Point2::origin());
    tags.tag(9, "$EXTMAX").point(corner);
    tags.tag(0, "ENDSEC");
}

fn tables(tags: &mut Tags) {
    tags.tag(0, "SECTION").tag(2, "TABLES");
    tags.tag(0, "TABLE").tag(2, "LTYPE").tag(70, 1);
    tags.tag(0, "LTYPE").tag(2, "CONTINUOUS").tag(70, 0);
    tags.tag(3, "Solid line").tag(72, 65).tag(73, 0).tag(40, 0);
    tags.tag(0, "ENDTAB");
    tags.tag(0, "TABLE").tag(2, "LAYER").tag(70, LAYERS.len());
    for layer in &LAYERS {
        tags.tag(0, "LAYER").tag(2, layer.name).tag(70, 0);
        tags.tag(62, layer.aci).tag(6, "CONTINUOUS");
    }
    tags.tag(0, "ENDTAB").tag(0, "ENDSEC");
}

fn polyline(tags: &mut Tags, layer: &Layer, path: &Path) {
    let is_closed = matches!(path, Path::Closed(_));
    tags.tag(0, "POLYLINE").tag(8, layer.name).tag(66, 1);
    tags.point(Point2::origin()).tag(70, u8::from(is_closed));
    match path {
        Path::Open(points) => points.iter().for_each(|&p| vertex(tags, layer, p)),
        Path::Closed(contour) => {
            for segment in contour.segments() {
                vertex(tags, layer, segment.from);
                if is_arc(&segment) {
                    tags.tag(42, bulge(segment.bulge));
                }
            }
        }
    }
    tags.tag(0, "SEQEND").tag(8, layer.name);
}

fn vertex(tags: &mut Tags, layer: &Layer, point: Point2) {
    tags.tag(0, "VERTEX").tag(8, layer.name).point(point);
}

#[cfg(test)]
mod tests {
    use ::dxf::Drawing;
    use ::dxf::entities::EntityType;

    use super::super::sample::sample;
    use super::*;
    use crate::geometry::Vertex;

    #[test]
    fn another_reader_finds_every_line_where_it_was() {
        let sheet = sample();
        let drawing = Drawing::load(&mut dxf(&sheet).as_slice()).unwrap();
        let mut read = drawing.entities();
        for layer in &LAYERS {
            for path in layer.paths(&sheet) {
                let entity = read.next().unwrap();
                assert_eq!(entity.common.layer, layer.name);
                let EntityType::Polyline(polyline) = &entity.specific else {
                    panic!("only polylines are written");
                };
                let vertices = match path {
                    Path::Open(points) => {
                        points.iter().copied().map(Vertex::line).collect()
                    }
                    Path::Closed(contour) => contour.vertices.clone(),
                };
                assert_eq!(polyline.is_closed(), matches!(path, Path::Closed(_)));
                assert_eq!(polyline.vertices().count(), vertices.len());
                for (read, meant) in polyline.vertices().zip(&vertices) {
                    assert!((read.location.x - meant.point.x).abs() < 5.1e-7);
                    assert!((read.location.y - meant.point.y).abs() < 5.1e-7);
                    assert!((read.bulge - meant.bulge).abs() < 1.1e-9);
                }
            }
        }
        assert!(read.next().is_none());
    }

    #[test]
    fn layers_and_colours_are_those_of_the_table() {
        let drawing = Drawing::load(&mut dxf(&sample()).as_slice()).unwrap();
        for layer in &LAYERS {
            let read = drawing.layers().find(|l| l.name == layer.name).unwrap();
            assert_eq!(read.color.index(), Some(layer.aci));
        }
    }
}
