//! Bytes as text: UTF-8, or what the file says, since old programs write in the code page of
//! their machine.

use encoding_rs::{Encoding, WINDOWS_1252};
use std::borrow::Cow;

/// What the bytes of a file that is not UTF-8 stand for.
pub(super) type CodePage = &'static Encoding;

/// Bytes as text.
pub(super) fn text(bytes: &[u8], page: CodePage) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => page.decode_without_bom_handling(bytes).0,
    }
}

/// The text of an XML file: by its byte order mark, its declaration (XML 1.0, appendix F), or
/// else Western European.
pub(super) fn xml(bytes: &[u8]) -> Cow<'_, str> {
    if let Some((encoding, mark)) = Encoding::for_bom(bytes) {
        return encoding.decode_without_bom_handling(&bytes[mark..]).0;
    }
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]);
    let declared = head.split_once("encoding").and_then(|(_, rest)| {
        let quoted = rest.trim_start_matches([' ', '=']).get(1..)?;
        let label = quoted.split(['"', '\'']).next()?;
        Encoding::for_label(label.as_bytes())
    });
    text(bytes, declared.unwrap_or(WINDOWS_1252))
}

/// The code page that the header of a DXF names (`$DWGCODEPAGE`).
pub(super) fn code_page(bytes: &[u8]) -> CodePage {
    const KEY: &[u8] = b"$DWGCODEPAGE";
    let at = bytes.windows(KEY.len()).position(|window| window == KEY);
    let after = at.map_or(&[][..], |at| &bytes[at + KEY.len()..]);
    let value = String::from_utf8_lossy(&after[..after.len().min(40)]).to_lowercase();
    let digits = value.split_once("ansi_").map(|(_, rest)| {
        rest.chars().take_while(char::is_ascii_digit).collect::<String>()
    });
    let label = match digits.as_deref() {
        Some("932") => "shift_jis".to_owned(),
        Some("936") => "gbk".to_owned(),
        Some("949") => "euc-kr".to_owned(),
        Some("950") => "big5".to_owned(),
        Some(number) => format!("windows-{number}"),
        None => String::new(),
    };
    Encoding::for_label(label.as_bytes()).unwrap_or(WINDOWS_1252)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_in_the_code_page_of_the_file() {
        for (page, bytes, wanted) in [
            ("ANSI_1252", &b"Gravur \x80 \xfc"[..], "Gravur \u{20ac} \u{fc}"),
            ("ansi_1251", b"\xd0\xe5\xe7", "\u{420}\u{435}\u{437}"),
            ("ANSI_932", b"\x83J\x83b\x83g", "\u{30ab}\u{30c3}\u{30c8}"),
            ("dos850", b"\xfc", "\u{fc}"),
            ("ANSI_936", "\u{5207}\u{5272}".as_bytes(), "\u{5207}\u{5272}"),
        ] {
            let file = format!("  9\r\n$DWGCODEPAGE\r\n  3\r\n{page}\r\n");
            assert_eq!(text(bytes, code_page(file.as_bytes())), wanted, "{page}");
        }
    }

    #[test]
    fn xml_is_read_as_its_mark_or_declaration_says() {
        let utf_16: Vec<u8> =
            "\u{feff}<svg/>".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert_eq!(xml(&utf_16), "<svg/>");
        assert_eq!(
            xml(b"<?xml encoding='iso-8859-2'?>\xb1"),
            "<?xml encoding='iso-8859-2'?>\u{105}"
        );
        assert_eq!(xml(b"<svg>\xe4</svg>"), "<svg>\u{e4}</svg>");
    }
}
