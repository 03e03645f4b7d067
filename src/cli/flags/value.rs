//! Values of options, as they are typed.

use crate::geometry::{Point3, Vector3};
use crate::job::{Depth, Fix, Scale};
use crate::joint::Joint;
use crate::structure::AxisRule;
use clap::ValueEnum;
use clap::builder::PossibleValue;

impl ValueEnum for Joint {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let mut about = self.words().to_owned();
        about[..1].make_ascii_uppercase();
        Some(PossibleValue::new(self.name()).help(about))
    }
}

/// How hard to nest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum EffortLevel {
    /// One order of parts
    Quick,
    /// Some orders
    Normal,
    /// Many orders
    Thorough,
}

pub(super) fn numbers(text: &str) -> Result<Vec<f64>, String> {
    let number = |word: &str| match word.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(format!("{word:?} is no number")),
    };
    text.split(',').map(number).collect()
}

pub(super) fn seconds(text: &str) -> Result<f64, String> {
    match numbers(text)?.as_slice() {
        &[seconds] if seconds > 0.0 && seconds <= 1e6 => Ok(seconds),
        _ => Err(format!("{text:?} is no number of seconds")),
    }
}

pub(super) fn scale(text: &str) -> Result<Scale, String> {
    let wrong = || format!("{text:?} is no scale; write 1:50 for a fiftieth");
    let (one, many) = text.split_once(':').ok_or_else(wrong)?;
    match (numbers(one)?.as_slice(), numbers(many)?.as_slice()) {
        (&[one], &[many]) if one > 0.0 && many > 0.0 => {
            Ok(Scale { text: text.to_owned(), factor: one / many })
        }
        _ => Err(wrong()),
    }
}

pub(super) fn axis_rule(text: &str) -> Result<AxisRule, String> {
    let triple = |text: &str| match numbers(text)?.as_slice() {
        &[x, y, z] => Ok([x, y, z]),
        other => Err(format!("three numbers X,Y,Z are needed, found {}", other.len())),
    };
    match text {
        "vn" => Ok(AxisRule::File),
        "normal" => Ok(AxisRule::Normal),
        _ => match text.strip_prefix("point:") {
            Some(point) => Ok(AxisRule::Through(Point3::from(triple(point)?))),
            None => {
                let direction = Vector3::from(triple(text).map_err(|error| {
                    format!("{error}; use vn, normal, X,Y,Z or point:X,Y,Z")
                })?);
                if direction.norm() > 0.0 {
                    Ok(AxisRule::Parallel(direction))
                } else {
                    Err("the direction 0,0,0 points nowhere".to_owned())
                }
            }
        },
    }
}

pub(super) fn depth(text: &str) -> Result<Depth, String> {
    match numbers(text)?.as_slice() {
        &[below, above] if below >= 0.0 && above >= 0.0 && below + above > 0.0 => {
            Ok(Depth { below, above })
        }
        _ => Err(format!("{text:?} is no depth; write 20,20 for 20 mm on each side")),
    }
}

pub(super) fn fix(text: &str) -> Result<Fix, String> {
    match text {
        "none" => Ok(Fix::None),
        "boundary" => Ok(Fix::Boundary),
        "lowest" => Ok(Fix::Lowest),
        list => {
            let node = |word: &str| {
                word.trim().parse::<usize>().map_err(|_| {
                    format!("{word:?} is no node; use none, boundary, lowest or numbers")
                })
            };
            list.split(',').map(node).collect::<Result<_, _>>().map(Fix::Nodes)
        }
    }
}

pub(super) fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(mm) if (0.0..=1e6).contains(&mm) => Ok(mm),
        _ => Err(format!("{text:?} is no length in mm")),
    }
}

/// A scale and a template.
#[derive(Debug, Clone, PartialEq)]
pub struct ForScale {
    pub scale: Scale,
    pub template: String,
}

/// A scale, and the template if it is not the default.
pub(super) fn for_scale(text: &str) -> Result<ForScale, String> {
    let (one, template) = text.split_once(',').unwrap_or((text, "pmma-cast-3"));
    Ok(ForScale { scale: scale(one)?, template: template.to_owned() })
}

/// One length for both, or two.
pub(super) fn cell(text: &str) -> Result<[f64; 2], String> {
    let (first, second) = text.split_once(',').unwrap_or((text, text));
    match (length(first)?, length(second)?) {
        (first, second) if first > 0.0 && second > 0.0 => Ok([first, second]),
        _ => Err(format!("{text:?} is no cell; write 40, or 60,40")),
    }
}

pub(super) fn size(text: &str) -> Result<[f64; 2], String> {
    let wrong = || format!("{text:?} is no size; write 600x400 for 600 by 400 mm");
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    match (length(width)?, length(height)?) {
        (width, height) if width > 0.0 && height > 0.0 => Ok([width, height]),
        _ => Err(wrong()),
    }
}

/// A size of sheet, and how many there are.
pub(super) fn sheet(text: &str) -> Result<([f64; 2], Option<usize>), String> {
    let Some((size_text, count)) = text.split_once(':') else {
        return size(text).map(|size| (size, None));
    };
    match count.parse() {
        Ok(count) if count > 0 => Ok((size(size_text)?, Some(count))),
        _ => Err(format!("{count:?} is no number of sheets; write 600x400:3 for three")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_and_axes_are_read_as_written() {
        assert!((scale("1:50").unwrap().factor - 0.02).abs() < 1e-15);
        assert!(scale("1:0").is_err());
        assert!(axis_rule("0,0,0").is_err());
        assert_eq!(
            axis_rule("point:1,2,-3"),
            Ok(AxisRule::Through(Point3::new(1.0, 2.0, -3.0)))
        );
    }
}
