//! Meshes read by `tobj` beside our own reader (docs/decisions/0003): the same faces, by
//! the positions of their corners, for `tobj` renumbers vertices.

use finwright::structure::{AxisRule, Draft, ObjOptions, read_obj};
use finwright::units::Unit;

/// Corners of all faces in order, as `tobj` reads them.
fn corners_by_tobj(text: &str) -> Vec<Vec<[f32; 3]>> {
    let options = tobj::LoadOptions::default();
    let no_materials = |_: &std::path::Path| Err(tobj::LoadError::GenericFailure);
    let (models, _) =
        tobj::load_obj_buf(&mut text.as_bytes(), &options, no_materials).unwrap();
    let mut faces = Vec::new();
    for mesh in models.iter().map(|model| &model.mesh) {
        let point = |&k: &u32| {
            let at = 3 * k as usize;
            [mesh.positions[at], mesh.positions[at + 1], mesh.positions[at + 2]]
        };
        let arities: Vec<usize> = match mesh.face_arities.as_slice() {
            [] => vec![3; mesh.indices.len() / 3],
            arities => arities.iter().map(|&count| count as usize).collect(),
        };
        let mut rest = mesh.indices.as_slice();
        for count in arities {
            let (face, more) = rest.split_at(count);
            faces.push(face.iter().map(point).collect());
            rest = more;
        }
    }
    faces
}

/// The same as our reader has them.
fn corners_by_us(draft: &Draft) -> Vec<Vec<[f32; 3]>> {
    let point = |&node: &usize| draft.positions[node].coords.map(|x| x as f32).into();
    draft.faces.iter().map(|face| face.iter().map(point).collect()).collect()
}

#[test]
fn tobj_reads_the_same_faces() {
    for name in ["mixed", "bricks"] {
        let path = format!("{}/fixtures/{name}.obj", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).unwrap();
        let options =
            ObjOptions { unit: Unit::Millimetre, axes: AxisRule::File, weld_mm: 0.0 };
        let (draft, _) = read_obj(&text, &options).unwrap();
        let (ours, theirs) = (corners_by_us(&draft), corners_by_tobj(&text));
        assert!(!ours.is_empty(), "{name}");
        assert_eq!(ours, theirs, "{name}");
    }
}
