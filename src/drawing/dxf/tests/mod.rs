//! What is read of DXF files.

use super::*;
use crate::drawing::LAYERS;
use crate::geometry::Rect;

fn file(header: &str, entities: &str) -> Vec<u8> {
    let spaced = format!(
        "0 SECTION 2 HEADER {header} 0 ENDSEC 0 SECTION 2 ENTITIES {entities} 0 ENDSEC 0 EOF"
    );
    spaced.split_whitespace().collect::<Vec<_>>().join("\r\n").into_bytes()
}

#[test]
fn lines_and_arcs_become_one_contour_in_any_order_and_direction() {
    let entities = "0 LINE 8 cut_outer 10 0 20 0 11 10 21 0 \
                    0 LINE 8 CUT_OUTER 10 0 20 4 11 10 21 4 \
                    0 ARC 8 CUT_OUTER 10 10 20 2 40 2 50 270 51 90 \
                    0 LINE 8 CUT_OUTER 10 0 20 4 11 0 21 0";
    let drawing =
        read_dxf(&file("9 $INSUNITS 70 4", entities), &Reading::of(&LAYERS)).unwrap();
    let [curve] = drawing.curves.as_slice() else { panic!("{drawing:?}") };
    assert!(curve.closed && curve.layer == "CUT_OUTER" && drawing.says_unit);
    let area = 40.0 + 2.0 * std::f64::consts::PI;
    assert!((curve.contour().signed_area().abs() - area).abs() < 1e-9);
}

#[test]
fn a_line_drawn_twice_is_kept_once_and_told() {
    let entities = "0 LINE 8 CUT_OUTER 10 0 20 0 11 10 21 0 \
                    0 LINE 8 CUT_OUTER 10 10 20 0 11 0 21 0 \
                    0 LINE 8 CUT_OUTER 10 10 20 0 11 0 21 9 \
                    0 LINE 8 CUT_OUTER 10 0 20 9 11 0 21 0";
    let drawing = read_dxf(&file("", entities), &Reading::of(&LAYERS)).unwrap();
    assert_eq!((drawing.curves.len(), drawing.doubled.len()), (1, 1));
    assert!(drawing.curves[0].closed && !drawing.says_unit);
}

#[test]
fn inches_become_millimetres_and_a_turned_over_polyline_is_mirrored() {
    let entities = "0 LWPOLYLINE 8 CUT_OUTER 90 3 70 1 \
                    10 1 20 0 42 0.5 10 2 20 0 10 2 20 1 230 -1";
    let drawing =
        read_dxf(&file("9 $INSUNITS 70 1", entities), &Reading::of(&LAYERS)).unwrap();
    let first = drawing.curves[0].vertices[0];
    assert!((first.point.x + 25.4).abs() < 1e-12 && (first.bulge + 0.5).abs() < 1e-12);
}

#[test]
fn half_an_ellipse_and_a_spline_become_one_contour() {
    // The spline is the straight line back, as a cubic.
    let entities = "0 ELLIPSE 8 CUT_OUTER 10 5 20 0 11 3 21 0 40 0.5 41 0 42 3.141592653589793 \
                    0 SPLINE 8 CUT_OUTER 70 8 71 3 40 0 40 0 40 0 40 0 40 1 40 1 40 1 40 1 \
                    10 2 20 0 10 4 20 0 10 6 20 0 10 8 20 0";
    let drawing =
        read_dxf(&file("9 $INSUNITS 70 1", entities), &Reading::of(&LAYERS)).unwrap();
    let [curve] = drawing.curves.as_slice() else { panic!("{drawing:?}") };
    assert!(curve.closed && drawing.unread.is_empty());
    let area = std::f64::consts::PI * 3.0 * 1.5 / 2.0 * 25.4 * 25.4;
    assert!((curve.contour().signed_area().abs() / area - 1.0).abs() < 1e-3);
}

#[test]
fn what_is_no_dxf_is_an_error_with_its_line() {
    let error =
        read_dxf(b"0\nSECTION\nhello\nworld\n", &Reading::of(&LAYERS)).unwrap_err();
    assert!(matches!(error, DrawingError::Dxf { line: 3, .. }), "{error}");
    assert_eq!(
        read_dxf(b"AutoCAD Binary DXF\r\n", &Reading::of(&LAYERS)),
        Err(DrawingError::BinaryDxf)
    );
    assert!(read_dxf(b"", &Reading::of(&LAYERS)).is_err());
}

/// Sizes of all curves of these entities, blocks and layers.
fn sizes(entities: &str, blocks: &str) -> Vec<[f64; 2]> {
    let text = format!(
        "0 SECTION 2 TABLES 0 LAYER 2 Off 62 -7 0 LAYER 2 Cold 70 1 0 ENDSEC \
         0 SECTION 2 BLOCKS {blocks} 0 ENDSEC 0 SECTION 2 ENTITIES {entities} 0 ENDSEC 0 EOF"
    );
    let text = text.split_whitespace().collect::<Vec<_>>().join("\n") + "\n\n\n";
    let drawing = read_dxf(text.as_bytes(), &Reading::of(&LAYERS)).unwrap();
    let size = |curve: &Curve| {
        let size = Rect::around(&curve.contour().flattened(0.001)).size();
        [size.x, size.y].map(|mm| (mm * 100.0).round() / 100.0)
    };
    drawing.curves.iter().map(size).collect()
}

#[test]
fn blocks_are_drawn_turned_mirrored_stretched_and_in_rows() {
    let blocks = "0 BLOCK 2 Plate 10 5 20 5 \
        0 LWPOLYLINE 8 0 90 3 70 1 10 5 20 5 10 45 20 5 10 45 20 25 0 ENDBLK \
        0 BLOCK 2 Two 0 INSERT 2 PLATE 0 CIRCLE 8 0 10 0 20 0 40 4 0 INSERT 2 Two 0 ENDBLK";
    let plate = [40.0, 20.0];
    assert_eq!(sizes("0 INSERT 2 plate 10 7 20 7 230 -1", blocks), [plate]);
    assert_eq!(sizes("0 INSERT 2 Plate 70 3 71 2 44 50 45 30", blocks), [plate; 6]);
    assert_eq!(sizes("0 INSERT 2 Plate 50 90 41 -2", blocks), [[20.0, 80.0]]);
    assert_eq!(sizes("0 INSERT 2 Two 42 2", blocks), [[40.0, 40.0], [8.0, 16.0]]);
}

#[test]
fn only_what_is_seen_in_model_space_is_drawn() {
    let line = |codes: &str| format!("0 LINE {codes} 10 0 20 0 11 9 21 0 ");
    for codes in ["8 Off", "8 cold", "8 0 60 1", "8 0 67 1"] {
        assert!(sizes(&line(codes), "").is_empty(), "{codes}");
    }
    assert_eq!(sizes(&line("8 0 230 -1"), ""), [[9.0, 0.0]]);
    let upright = "0 LWPOLYLINE 8 0 210 0 220 -1 230 0 90 2 70 0 10 0 20 0 10 9 20 0";
    assert!(sizes(upright, "").is_empty());
}

#[test]
fn a_number_that_is_none_is_an_error_with_its_line() {
    let bytes = file("", "0 CIRCLE 8 0 10 0 20 0 40 5,5");
    let error = read_dxf(&bytes, &Reading::of(&LAYERS)).unwrap_err();
    assert!(matches!(error, DrawingError::Dxf { line: 20, .. }), "{error}");
}

#[test]
fn a_binary_file_is_read_as_the_same_lines() {
    let mut bytes = b"AutoCAD Binary DXF\r\n\x1a\0".to_vec();
    let mut text = |code: i16, text: &str| {
        bytes.extend(code.to_le_bytes());
        bytes.extend(text.bytes().chain([0]));
    };
    text(0, "SECTION");
    text(2, "ENTITIES");
    text(0, "CIRCLE");
    text(8, "CUT_OUTER");
    for (code, number) in [(10_i16, 3.0_f64), (20, 4.0), (40, 2.5)] {
        bytes.extend(code.to_le_bytes());
        bytes.extend(number.to_le_bytes());
    }
    for word in ["ENDSEC", "EOF"] {
        bytes.extend([0, 0]);
        bytes.extend(word.bytes().chain([0]));
    }
    let drawing = read_dxf(&bytes, &Reading::of(&LAYERS)).unwrap();
    assert_eq!(drawing.curves[0].vertices[0].point, Point2::new(5.5, 4.0));
}
