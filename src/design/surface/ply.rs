//! Surfaces as PLY (Turk 1994, The PLY polygon file format), text or binary of either
//! order: vertices `x y z` with normals `nx ny nz` as axes, faces as lists of vertices.

use crate::design::surface::{FormatError, Polygons};
use crate::geometry::{Point3, Vector3};

/// Reads a PLY file, in its own units; elements and properties that say nothing of a
/// surface are passed over.
///
/// # Errors
/// [`FormatError`] if it is none, with the line of its header or the row.
pub fn read_ply(bytes: &[u8]) -> Result<Polygons, FormatError> {
    let (header, at) = Header::read(bytes)?;
    let mut values = Values { order: header.order, rest: &bytes[at..] };
    let mut polygons = Polygons::default();
    let mut axes = Vec::new();
    for element in &header.elements {
        for number in 0..element.count {
            let name = || element.name.clone();
            let row = element.row(&mut values);
            let row =
                row.ok_or_else(|| FormatError::PlyRow { element: name(), number })?;
            let scalar = |name: &str| {
                let named = element.properties.iter().position(|p| p.name == name)?;
                row[named].first().copied()
            };
            let vector = |[x, y, z]: [&str; 3]| {
                Some(Vector3::new(scalar(x)?, scalar(y)?, scalar(z)?))
            };
            match element.name.as_str() {
                "vertex" => {
                    let at = vector(["x", "y", "z"]);
                    let at = at.ok_or(FormatError::PlyWithout { what: "x, y, z" })?;
                    polygons.positions.push(Point3::from(at));
                    axes.extend(vector(["nx", "ny", "nz"]));
                }
                "face" => {
                    let is_list = |p: &Property| {
                        ["vertex_indices", "vertex_index"].contains(&p.name.as_str())
                    };
                    let list = element.properties.iter().position(is_list);
                    let list =
                        list.ok_or(FormatError::PlyWithout { what: "vertex_indices" })?;
                    // A negative number is out of range whatever it becomes.
                    let whole = |&x: &f64| if x < 0.0 { usize::MAX } else { x as usize };
                    polygons.faces.push(row[list].iter().map(whole).collect());
                }
                _ => {}
            }
        }
    }
    let all = !axes.is_empty() && axes.len() == polygons.positions.len();
    polygons.axes = all.then_some(axes);
    Ok(polygons)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Order {
    Text,
    LittleEndian,
    BigEndian,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Signed(usize),
    Unsigned(usize),
    Float(usize),
}

struct Property {
    name: String,
    /// Of the count, for a list.
    count: Option<Kind>,
    kind: Kind,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

struct Header {
    order: Order,
    elements: Vec<Element>,
}

impl Kind {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::Signed(1),
            "uchar" | "uint8" => Self::Unsigned(1),
            "short" | "int16" => Self::Signed(2),
            "ushort" | "uint16" => Self::Unsigned(2),
            "int" | "int32" => Self::Signed(4),
            "uint" | "uint32" => Self::Unsigned(4),
            "float" | "float32" => Self::Float(4),
            "double" | "float64" => Self::Float(8),
            _ => return None,
        })
    }
}

impl Header {
    /// The header, and where the rows begin.
    fn read(bytes: &[u8]) -> Result<(Self, usize), FormatError> {
        let (mut order, mut elements, mut at) = (None, Vec::<Element>::new(), 0);
        for (k, line) in bytes.split_inclusive(|&byte| byte == b'\n').enumerate() {
            at += line.len();
            let text = String::from_utf8_lossy(line).trim().to_owned();
            let words: Vec<&str> = text.split_whitespace().collect();
            let bad = || FormatError::PlyHeader { line: k + 1, text: text.clone() };
            match words[..] {
                ["ply"] if k == 0 => {}
                _ if k == 0 => return Err(bad()),
                ["end_header"] => {
                    let order = order.ok_or_else(bad)?;
                    return Ok((Self { order, elements }, at));
                }
                ["format", name, _] => {
                    order = match name {
                        "ascii" => Some(Order::Text),
                        "binary_little_endian" => Some(Order::LittleEndian),
                        "binary_big_endian" => Some(Order::BigEndian),
                        _ => return Err(bad()),
                    };
                }
                ["element", name, count] => elements.push(Element {
                    name: name.to_owned(),
                    count: count.parse().map_err(|_| bad())?,
                    properties: Vec::new(),
                }),
                ["property", ref words @ ..] => {
                    let element = elements.last_mut().ok_or_else(bad)?;
                    element.properties.push(Property::read(words).ok_or_else(bad)?);
                }
                [] | ["comment" | "obj_info", ..] => {}
                _ => return Err(bad()),
            }
        }
        Err(FormatError::PlyWithout { what: "end_header" })
    }
}

impl Property {
    fn read(words: &[&str]) -> Option<Self> {
        let (count, kind, name) = match *words {
            ["list", count, kind, name] => (Some(Kind::named(count)?), kind, name),
            [kind, name] => (None, kind, name),
            _ => return None,
        };
        Some(Self { name: name.to_owned(), count, kind: Kind::named(kind)? })
    }
}

impl Element {
    /// The numbers of each property of the next row.
    fn row(&self, values: &mut Values) -> Option<Vec<Vec<f64>>> {
        if self.properties.is_empty() {
            return None;
        }
        let read = |property: &Property| {
            let count = match property.count {
                Some(kind) => values.next(kind)?,
                None => 1.0,
            };
            // No list is longer than what is left of the file.
            let count = (count >= 0.0).then_some(count as usize)?;
            (count <= values.rest.len()).then_some(())?;
            (0..count).map(|_| values.next(property.kind)).collect()
        };
        self.properties.iter().map(read).collect()
    }
}

/// What is left of the file.
struct Values<'a> {
    order: Order,
    rest: &'a [u8],
}

impl Values<'_> {
    fn next(&mut self, kind: Kind) -> Option<f64> {
        if self.order == Order::Text {
            let rest = self.rest.trim_ascii_start();
            let end = rest.iter().position(u8::is_ascii_whitespace);
            let (word, rest) = rest.split_at(end.unwrap_or(rest.len()));
            self.rest = rest;
            return std::str::from_utf8(word).ok()?.parse().ok();
        }
        let (Kind::Signed(size) | Kind::Unsigned(size) | Kind::Float(size)) = kind;
        let (own, rest) = self.rest.split_at_checked(size)?;
        self.rest = rest;
        let mut wide = [0; 8];
        wide[..size].copy_from_slice(own);
        if self.order == Order::BigEndian {
            wide[..size].reverse();
        }
        let whole = u64::from_le_bytes(wide);
        let shift = 64 - 8 * size as u32;
        Some(match kind {
            Kind::Float(4) => f64::from(f32::from_bits(whole as u32)),
            Kind::Float(_) => f64::from_bits(whole),
            Kind::Unsigned(_) => whole as f64,
            Kind::Signed(_) => (((whole << shift) as i64) >> shift) as f64,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(format: &str) -> String {
        format!(
            "ply\nformat {format} 1.0\ncomment a patch\nelement vertex 3\n\
             property float x\nproperty double y\nproperty short z\nelement face 1\n\
             property uchar flags\nproperty list uchar int vertex_indices\nend_header\n"
        )
    }

    #[test]
    fn all_three_formats_give_the_same_faces() {
        let rows: [(f32, f64, i16); 3] = [(0.0, 0.5, 0), (1.5, 0.0, -3), (0.0, 1.0, 7)];
        let mut text = header("ascii");
        rows.iter().for_each(|(x, y, z)| text += &format!("{x} {y} {z}\n"));
        text += "9 3 0 1 2\n";
        let mut little = header("binary_little_endian").into_bytes();
        let mut big = header("binary_big_endian").into_bytes();
        for (x, y, z) in rows {
            little.extend(x.to_le_bytes());
            little.extend(y.to_le_bytes());
            little.extend(z.to_le_bytes());
            big.extend(x.to_be_bytes());
            big.extend(y.to_be_bytes());
            big.extend(z.to_be_bytes());
        }
        for (bytes, of) in [
            (&mut little, i32::to_le_bytes as fn(i32) -> [u8; 4]),
            (&mut big, i32::to_be_bytes),
        ] {
            bytes.extend([9, 3]);
            (0..3).for_each(|k| bytes.extend(of(k)));
        }
        let read = read_ply(text.as_bytes()).unwrap();
        assert_eq!(read.faces, [[0, 1, 2]]);
        assert_eq!(read.positions[1], Point3::new(1.5, 0.0, -3.0));
        assert_eq!(read, read_ply(&little).unwrap());
        assert_eq!(read, read_ply(&big).unwrap());
        little.pop();
        let short = FormatError::PlyRow { element: "face".into(), number: 0 };
        assert_eq!(read_ply(&little), Err(short));
    }

    #[test]
    fn what_is_no_header_is_named_with_its_line() {
        let wrong = header("ascii").replace("short z", "shrt z");
        assert!(matches!(
            read_ply(wrong.as_bytes()),
            Err(FormatError::PlyHeader { line: 7, .. })
        ));
        assert!(read_ply(b"").is_err() && read_ply(b"ply\n").is_err());
        let huge = "ply\nformat ascii 1.0\nelement vertex 99999999999\nend_header\n";
        assert!(read_ply(huge.as_bytes()).is_err());
    }
}
