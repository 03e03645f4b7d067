//! SVG: one user unit is a millimetre, a layer is a group, nothing is transformed.

use super::arcs::{halved_until, is_arc};
use super::number::length;
use super::{LAYERS, LINE_WIDTH, Layer};
use crate::geometry::{Point2, Segment};
use crate::sheets::{Path, Sheet};

/// The sheet as SVG 1.1 with Inkscape layers.
pub fn svg(sheet: &Sheet) -> Vec<u8> {
    svg_in(sheet, &LAYERS)
}

/// The same in other colours.
pub fn svg_in(sheet: &Sheet, layers: &[Layer; 5]) -> Vec<u8> {
    let (width, height) = (length(sheet.width), length(sheet.height));
    let mut text = format!(
        concat!(
            r#"<?xml version="1.0" encoding="UTF-8"?>"#,
            "\n",
            r#"<svg xmlns="http://www.w3.org/2000/svg" "#,
            r#"xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" "#,
            r#"version="1.1" width="{}mm" height="{}mm" viewBox="0 0 {} {}">"#,
            "\n"
        ),
        width, height, width, height
    );
    for layer in layers {
        text.push_str(&open_group(layer));
        for path in layer.paths(sheet) {
            text.push_str(&format!("<path d=\"{}\"/>\n", commands(path, sheet.height)));
        }
        text.push_str("</g>\n");
    }
    text.push_str("</svg>\n");
    text.into_bytes()
}

fn open_group(layer: &Layer) -> String {
    let name = layer.name;
    let [r, g, b] = layer.rgb;
    let width = length(LINE_WIDTH);
    format!(
        "<g id=\"{name}\" inkscape:groupmode=\"layer\" inkscape:label=\"{name}\" \
         fill=\"none\" stroke=\"#{r:02x}{g:02x}{b:02x}\" stroke-width=\"{width}\">\n"
    )
}

/// The path in SVG's own small language; `height` turns y downwards.
fn commands(path: &Path, height: f64) -> String {
    match path {
        Path::Open(points) => {
            let points: Vec<_> = points.iter().map(|&p| coordinates(p, height)).collect();
            format!("M{}", points.join("L"))
        }
        Path::Closed(contour) => {
            let start = contour.vertices.first().map(|v| coordinates(v.point, height));
            let mut text = format!("M{}", start.unwrap_or_default());
            let mut segments = contour.segments().peekable();
            while let Some(segment) = segments.next() {
                let is_way_home = segments.peek().is_none();
                if !is_arc(&segment) {
                    if !is_way_home {
                        text.push_str(&format!("L{}", coordinates(segment.to, height)));
                    }
                    continue;
                }
                for piece in halved_until(segment, &is_quarter_at_most) {
                    text.push_str(&arc_command(&piece, height));
                }
            }
            text + "Z"
        }
    }
}

/// Beyond a quarter turn, SVG's radius and end points leave the centre badly determined:
/// at a half turn of radius 100, the last digit of the radius moves it by 0.01 mm.
fn is_quarter_at_most(segment: &Segment) -> bool {
    segment.bulge.abs() < 0.4143 // tan(90° / 4), and a little
}

fn arc_command(segment: &Segment, height: f64) -> String {
    let chord = (segment.to - segment.from).norm();
    let bulge = segment.bulge;
    let radius = length(chord * (1.0 + bulge * bulge) / (4.0 * bulge.abs()));
    // With y downwards, a positive sweep is clockwise to the eye.
    let sweep = u8::from(bulge < 0.0);
    format!("A{radius} {radius} 0 0 {sweep} {}", coordinates(segment.to, height))
}

fn coordinates(point: Point2, height: f64) -> String {
    format!("{} {}", length(point.x), length(height - point.y))
}

#[cfg(test)]
mod tests {
    use super::super::sample::sample;
    use super::*;
    use crate::geometry::{Contour, Vertex};

    #[test]
    fn paths_read_back_are_the_strokes_of_the_sheet() {
        let sheet = sample();
        let text = String::from_utf8(svg(&sheet)).unwrap();
        let mut written = text.lines().filter(|line| line.starts_with("<path"));
        for path in LAYERS.iter().flat_map(|layer| layer.paths(&sheet)) {
            let d = written.next().unwrap().split('"').nth(1).unwrap();
            let read = read(d, sheet.height);
            match path {
                Path::Open(points) => {
                    assert!(!d.ends_with('Z'));
                    assert_eq!(read.vertices.len(), points.len());
                    for (vertex, point) in read.vertices.iter().zip(points) {
                        assert!((vertex.point - point).norm() < 1e-6);
                    }
                }
                Path::Closed(contour) => {
                    assert!(d.ends_with('Z'));
                    assert!((read.length() - contour.length()).abs() < 2e-5, "{d}");
                    let area = read.signed_area() - contour.signed_area();
                    assert!(area.abs() < 5e-4, "{area} {d}");
                }
            }
        }
        assert!(written.next().is_none());
    }

    /// Path data as a contour with y upwards, arcs as bulges.
    fn read(d: &str, height: f64) -> Contour {
        let mut vertices: Vec<Vertex> = Vec::new();
        let commands = ['M', 'L', 'A'];
        let starts = d.match_indices(commands).map(|(at, letter)| at + letter.len());
        for body in starts.map(|at| d[at..].split(['L', 'A', 'Z']).next().unwrap()) {
            let numbers: Vec<f64> = body.split(' ').map(|n| n.parse().unwrap()).collect();
            let [.., x, y] = numbers[..] else { panic!("{d}") };
            let to = Point2::new(x, height - y);
            if let [radius, _, _, is_large, is_clockwise, _, _] = numbers[..] {
                assert!(is_large < 0.5);
                let from = vertices.last_mut().unwrap();
                let half = (to - from.point).norm() / 2.0;
                let bulge = half / (radius + (radius * radius - half * half).sqrt());
                from.bulge = if is_clockwise > 0.5 { -bulge } else { bulge };
            }
            vertices.push(Vertex::line(to));
        }
        if d.ends_with('Z')
            && vertices.first().map(|v| v.point) == vertices.last().map(|v| v.point)
        {
            vertices.pop();
        }
        Contour { vertices }
    }

    #[test]
    fn layers_are_groups_in_order_and_nothing_is_filled_or_transformed() {
        let text = String::from_utf8(svg(&sample())).unwrap();
        let ids =
            text.lines().filter_map(|l| l.strip_prefix("<g id=\"")?.split('"').next());
        assert!(ids.eq(LAYERS.iter().map(|layer| layer.name)));
        assert_eq!(text.matches("fill=\"none\"").count(), LAYERS.len());
        assert!(!text.contains("transform"));
        assert!(text.contains(r#"width="300mm" height="200mm" viewBox="0 0 300 200""#));
    }
}
