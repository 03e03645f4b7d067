//! A DXF file as group codes with their values, ASCII or binary.

use crate::drawing::DrawingError;
use crate::drawing::text::{CodePage, code_page, text};
use std::borrow::Cow;

/// A group code with its value.
pub(super) type Tag<'a> = (i32, Cow<'a, str>);

const BINARY: &[u8] = b"AutoCAD Binary DXF";

/// All tags up to the end of the file as the file has it (`0 EOF`).
pub(super) fn tags(bytes: &[u8]) -> Result<Vec<Tag<'_>>, DrawingError> {
    let tags = if bytes.starts_with(BINARY) { binary(bytes)? } else { ascii(bytes)? };
    let names_entities = |tag: &Tag| tag.0 == 2 && tag.1 == "ENTITIES";
    if tags.iter().any(names_entities) {
        return Ok(tags);
    }
    let (line, message) = (2 * tags.len(), "there is no ENTITIES section".to_owned());
    Err(DrawingError::Dxf { line, message })
}

fn ascii(bytes: &[u8]) -> Result<Vec<Tag<'_>>, DrawingError> {
    let page = code_page(bytes);
    let mut lines = bytes.split(|&byte| byte == b'\n').enumerate();
    let mut tags: Vec<Tag> = Vec::new();
    while let (Some((line, code)), Some((_, value))) = (lines.next(), lines.next()) {
        let code = text(code, page);
        let wrong = |_| DrawingError::Dxf {
            line: line + 1,
            message: format!("{:?} is no group code", code.trim()),
        };
        let code: i32 =
            code.trim_start_matches('\u{feff}').trim().parse().map_err(wrong)?;
        let value = trimmed(text(value, page));
        check(code, &value, line + 2)?;
        if code == 0 && value == "EOF" {
            break;
        }
        tags.push((code, value));
    }
    Ok(tags)
}

fn trimmed(text: Cow<'_, str>) -> Cow<'_, str> {
    match text {
        Cow::Borrowed(text) => Cow::Borrowed(text.trim()),
        Cow::Owned(text) => Cow::Owned(text.trim().to_owned()),
    }
}

/// Values of codes that are coordinates, lengths and angles must be numbers.
fn check(code: i32, value: &str, line: usize) -> Result<(), DrawingError> {
    let is_number = matches!(code, 10..=59 | 210..=239);
    if !is_number || value.parse::<f64>().is_ok() {
        return Ok(());
    }
    let message = format!("{value:?} is no number (group code {code})");
    Err(DrawingError::Dxf { line, message })
}

/// Binary tags (DXF Reference, "Binary DXF Files"): little-endian, codes of two bytes, before
/// R13 of one.
fn binary(bytes: &[u8]) -> Result<Vec<Tag<'_>>, DrawingError> {
    let page = code_page(bytes);
    let mut rest = bytes.get(BINARY.len() + 4..).ok_or(DrawingError::BinaryDxf)?;
    // The first tag is 0 SECTION: of a code of one byte the next byte is a letter.
    let wide = rest.get(1) == Some(&0);
    let mut tags: Vec<Tag> = Vec::new();
    loop {
        let value = code(&mut rest, wide)
            .and_then(|code| Some((code, value(&mut rest, code, page)?)));
        let Some((code, value)) = value else { return Err(DrawingError::BinaryDxf) };
        if code == 0 && value == "EOF" {
            return Ok(tags);
        }
        tags.push((code, value));
    }
}

fn taken<'a>(rest: &mut &'a [u8], count: usize) -> Option<&'a [u8]> {
    let (head, tail) = rest.split_at_checked(count)?;
    *rest = tail;
    Some(head)
}

fn code(rest: &mut &[u8], wide: bool) -> Option<i32> {
    let two = |rest: &mut &[u8]| {
        let bytes = taken(rest, 2)?.try_into().ok()?;
        Some(i32::from(i16::from_le_bytes(bytes)))
    };
    if wide {
        return two(rest);
    }
    match taken(rest, 1)? {
        [255] => two(rest),
        byte => Some(i32::from(byte[0])),
    }
}

fn value<'a>(rest: &mut &'a [u8], code: i32, page: CodePage) -> Option<Cow<'a, str>> {
    let count = match code {
        10..=59 | 110..=149 | 210..=239 | 460..=469 | 1010..=1059 => {
            let bytes = taken(rest, 8)?.try_into().ok()?;
            return Some(Cow::Owned(f64::from_le_bytes(bytes).to_string()));
        }
        60..=79 | 170..=179 | 270..=289 | 370..=389 | 400..=409 | 1060..=1070 => 2,
        90..=99 | 420..=429 | 440..=449 | 450..=459 | 1071 => 4,
        160..=169 => 8,
        290..=299 => 1,
        310..=319 | 1004 => {
            let count = usize::from(taken(rest, 1)?[0]);
            taken(rest, count)?;
            return Some(Cow::Borrowed(""));
        }
        _ => {
            let end = rest.iter().position(|&byte| byte == 0)?;
            let string = text(taken(rest, end)?, page);
            taken(rest, 1)?;
            return Some(string);
        }
    };
    let bytes = taken(rest, count)?;
    let negative = bytes.last().is_some_and(|byte| byte & 128 > 0);
    let mut wide = [if negative && count > 1 { 255 } else { 0 }; 8];
    wide[..count].copy_from_slice(bytes);
    Some(Cow::Owned(i64::from_le_bytes(wide).to_string()))
}
