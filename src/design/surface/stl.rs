//! Surfaces as STL, text or binary: triangles with corners of their own, which are welded
//! later.

use crate::design::surface::{FormatError, Polygons};
use crate::geometry::Point3;

/// Bytes of a binary file before its triangles, and of each triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Reads an STL file, in its own units.
///
/// # Errors
/// [`FormatError`] if it is none, with its line or its length.
pub fn read_stl(bytes: &[u8]) -> Result<Polygons, FormatError> {
    // Binary files may begin with `solid` as well: their length tells.
    let says = bytes.get(80..HEADER).and_then(|count| count.try_into().ok());
    let triangles = says.map_or(0, u32::from_le_bytes) as usize;
    let needed = HEADER + TRIANGLE * triangles;
    let starts = bytes.trim_ascii_start().get(..5);
    let is_text = starts.is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let corners = if bytes.len() == needed {
        binary(&bytes[HEADER..])
    } else if is_text {
        text(&String::from_utf8_lossy(bytes))?
    } else {
        let bytes = bytes.len();
        return Err(FormatError::StlLength { bytes, triangles, needed });
    };
    let faces = (0..corners.len() / 3).map(|k| vec![3 * k, 3 * k + 1, 3 * k + 2]);
    Ok(Polygons { faces: faces.collect(), positions: corners, axes: None })
}

fn binary(bytes: &[u8]) -> Vec<Point3> {
    let number = |at: &[u8]| f64::from(f32::from_le_bytes([at[0], at[1], at[2], at[3]]));
    let corner = |at: &[u8]| Point3::new(number(at), number(&at[4..]), number(&at[8..]));
    // After the normal, which follows from the corners.
    let corners = |t: &[u8]| [corner(&t[12..]), corner(&t[24..]), corner(&t[36..])];
    bytes.chunks_exact(TRIANGLE).flat_map(corners).collect()
}

fn text(text: &str) -> Result<Vec<Point3>, FormatError> {
    let mut corners = Vec::new();
    for (k, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        let word = words.next().unwrap_or_default().to_ascii_lowercase();
        let bad = || FormatError::StlLine { line: k + 1, text: line.trim().to_owned() };
        match word.as_str() {
            "vertex" => {
                let numbers: Vec<f64> =
                    words.map_while(|word| word.parse().ok()).collect();
                let &[x, y, z] = numbers.as_slice() else { return Err(bad()) };
                corners.push(Point3::new(x, y, z));
            }
            "endloop" if !corners.len().is_multiple_of(3) => return Err(bad()),
            "" | "solid" | "facet" | "outer" | "endloop" | "endfacet" | "endsolid" => {}
            _ => return Err(bad()),
        }
    }
    Ok(corners)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_and_binary_give_the_same_triangles() {
        let text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1.5 0 0\n\
                    vertex 0 1 -2e0\nendloop\nendfacet\nendsolid a\n";
        let mut binary = b"solid, in spite of its name".to_vec();
        binary.resize(80, b' ');
        binary.extend(1_u32.to_le_bytes());
        let numbers = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.5, 0.0, 0.0, 0.0, 1.0, -2.0];
        numbers.iter().for_each(|x: &f32| binary.extend(x.to_le_bytes()));
        binary.extend([0, 0]);
        let read = read_stl(text.as_bytes()).unwrap();
        assert_eq!(read.faces, [[0, 1, 2]]);
        assert_eq!(read, read_stl(&binary).unwrap());
        assert_eq!(read.positions[2], Point3::new(0.0, 1.0, -2.0));
        binary.pop();
        binary[..5].copy_from_slice(b"STLB ");
        let short = FormatError::StlLength { bytes: 133, triangles: 1, needed: 134 };
        assert_eq!(read_stl(&binary), Err(short));
        let line = text.replace("1.5", "one");
        assert!(matches!(
            read_stl(line.as_bytes()),
            Err(FormatError::StlLine { line: 5, .. })
        ));
    }
}
