//! Text as HTML.

/// Text with what HTML would take for markup written out.
pub(super) fn text(text: &str) -> String {
    let mut written = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => written.push_str("&amp;"),
            '<' => written.push_str("&lt;"),
            '>' => written.push_str("&gt;"),
            '"' => written.push_str("&quot;"),
            c => written.push(c),
        }
    }
    written
}

/// JSON that may stand inside a script element: nothing in it can end the element.
pub(super) fn script(value: &serde_json::Value) -> String {
    value.to_string().replace('<', "\\u003c")
}

/// A table; cells are HTML already. Numbers are set to the right.
pub(super) fn table(caption: &str, heads: &[&str], rows: &[Vec<String>]) -> String {
    let head: String =
        heads.iter().map(|h| format!("<th scope=\"col\">{h}</th>")).collect();
    let body: String = rows.iter().map(|cells| row(cells)).collect();
    let caption = text(caption);
    format!(
        "<div class=\"wide\"><table><caption>{caption}</caption><thead><tr>{head}</tr></thead>\
         <tbody>\n{body}</tbody></table></div>\n"
    )
}

fn row(cells: &[String]) -> String {
    let cell = |cell: &String| match cell.parse::<f64>() {
        Ok(_) => format!("<td class=\"n\">{cell}</td>"),
        Err(_) => format!("<td>{cell}</td>"),
    };
    format!("<tr>{}</tr>\n", cells.iter().map(cell).collect::<String>())
}

/// Something longer that opens on a click, and is open on paper.
pub(super) fn details(summary: &str, body: &str) -> String {
    format!("<details><summary>{}</summary>{body}</details>\n", text(summary))
}

/// The name of a part, which the script makes a link into space and onto its sheet.
pub(super) fn part(id: &str) -> String {
    let id = text(id);
    format!("<button type=\"button\" class=\"part\" data-part=\"{id}\">{id}</button>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_was_typed_can_become_markup() {
        assert_eq!(text("<b a=\"1\">&"), "&lt;b a=&quot;1&quot;&gt;&amp;");
        let value = serde_json::json!("</script><script>");
        assert!(!script(&value).contains('<'));
        let back: serde_json::Value = serde_json::from_str(&script(&value)).unwrap();
        assert_eq!(back, value);
    }
}
