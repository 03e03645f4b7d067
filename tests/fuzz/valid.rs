//! The valid structures and templates that are spoilt.

use finwright::geometry::{Point3, Vector3, trig};
use finwright::structure::Draft;
use finwright::template::{self, Template};
use std::f64::consts::{FRAC_PI_2, PI};

/// Sheets so small that strips are spliced, at times into pieces of one node.
pub(super) fn offcuts() -> Template {
    let mut template = template::read(&embedded("card-1.5"), "offcuts").unwrap();
    template.sheet.truncate(1);
    (template.sheet[0].width_mm, template.sheet[0].height_mm) = (110.0, 70.0);
    template
}

pub(super) fn embedded(name: &str) -> String {
    template::embedded(name).unwrap().to_owned()
}

pub(super) fn without_strips(json: &str) -> String {
    let mut value: serde_json::Value = serde_json::from_str(json).unwrap();
    let object = value.as_object_mut().unwrap();
    object.remove("strips");
    object.remove("fins");
    // One key a line, so that lines can be dropped.
    serde_json::to_string_pretty(&value).unwrap()
}

/// A flat patch of cells with upright axes.
pub(super) fn grid(columns: usize, rows: usize) -> Draft {
    let at = |i: usize, j: usize| j * (columns + 1) + i;
    let nodes = (0..=rows).flat_map(|j| (0..=columns).map(move |i| (i, j)));
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    let positions: Vec<Point3> =
        nodes.map(|(i, j)| Point3::new(60.0 * i as f64, 60.0 * j as f64, 0.0)).collect();
    Draft {
        name: "grid".into(),
        axes: vec![Vector3::z(); positions.len()],
        positions,
        faces: cells
            .map(|(i, j)| vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
            .collect(),
        ..Draft::default()
    }
    .with_depth(20.0, 20.0)
}

/// Two closed rings and the fins between them.
pub(super) fn ring(count: usize) -> Draft {
    let turn = |k: usize| 2.0 * PI * k as f64 / count as f64;
    let around = |radius: f64| {
        (0..count).map(move |k| {
            let (sin, cos) = (trig::sin(turn(k)), trig::sin(turn(k) + FRAC_PI_2));
            Point3::new(radius * cos, radius * sin, 0.0)
        })
    };
    let positions: Vec<Point3> = around(150.0).chain(around(250.0)).collect();
    Draft {
        name: "ring".into(),
        axes: vec![Vector3::z(); positions.len()],
        positions,
        faces: (0..count)
            .map(|k| vec![k, count + k, count + (k + 1) % count, (k + 1) % count])
            .collect(),
        ..Draft::default()
    }
    .with_depth(15.0, 15.0)
}

/// A cross of two strips: fins on some edges of the faces only.
pub(super) fn crossed() -> Draft {
    let positions = [(0.0, 0.0), (80.0, 0.0), (-80.0, 0.0), (0.0, 80.0), (0.0, -80.0)];
    Draft {
        name: "crossed".into(),
        positions: positions.map(|(x, y)| Point3::new(x, y, 0.0)).to_vec(),
        axes: vec![Vector3::z(); 5],
        fins: Some(vec![[0, 1], [0, 2], [0, 3], [0, 4]]),
        faces: vec![vec![0, 1, 3], vec![0, 3, 2], vec![0, 2, 4], vec![0, 4, 1]],
        fixed: Some(vec![1, 2]),
        ..Draft::default()
    }
    .with_depth(20.0, 10.0)
}
