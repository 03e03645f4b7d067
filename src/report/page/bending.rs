//! How tightly each part bends, for how long the sheet stands that, and what would help.

use crate::geometry::trig;
use crate::parts::{Body, Part, bends};
use crate::report::page::Page;
use crate::report::page::html::{self, table};
use crate::template::Template;

/// Least inner radius of a bend made over a hot wire, in thicknesses (plexiglas.de).
const HEATED: f64 = 2.0;

/// The tightest bend of each part.
pub(super) fn bending(page: &Page) -> String {
    let template = page.source.template;
    let rows = page.job.parts.iter().filter_map(|part| row(part, template));
    let rows: Vec<Vec<String>> = rows.collect();
    if rows.is_empty() {
        return "<p>No part bends.</p>\n".to_owned();
    }
    let heads = [
        "part",
        "at node",
        "fold °",
        "radius mm",
        "radius / thickness",
        "stands",
        "for years: sheet mm",
        "or scale ×",
        "hot: shorter by mm",
    ];
    let limits = &template.bend;
    let why = format!(
        "<p>A strip folds at its nodes; the sheet spreads the fold over the fins beside it. {} stands \
         a radius of {} times its thickness for years, of {} for weeks, and breaks at {}. A thinner \
         sheet, a larger scale, or a bend over a hot wire help where that is not enough; a bend of \
         radius {HEATED} × thickness makes the strip shorter by the last column, which is not in \
         the parts.</p>\n",
        html::text(&template.material.name),
        limits.long_term,
        limits.model,
        limits.crack
    );
    why + &table("Tightest bend of each part", &heads, &rows)
}

fn row(part: &Part, template: &Template) -> Option<Vec<String>> {
    let Body::Strip(body) = &part.body else { return None };
    let tightest = bends(body).into_iter().min_by(|a, b| a.1.total_cmp(&b.1));
    let (node, radius) = tightest.filter(|(_, radius)| radius.is_finite())?;
    let fold = body.folds.iter().find(|fold| fold.node == node)?.angle;
    let (limits, thickness) = (&template.bend, template.material.thickness_mm);
    let ratio = radius / thickness;
    let (word, class) = match ratio {
        r if r >= limits.long_term => ("years", ""),
        r if r >= limits.model => ("weeks, as a model", "note"),
        r if r >= limits.crack => ("it may craze", "warning"),
        _ => ("it breaks", "error"),
    };
    let short = ratio < limits.long_term;
    let help = [
        format!("{:.2}", radius / limits.long_term),
        format!("{:.2}", limits.long_term / ratio),
        format!("{:.3}", allowance(fold, thickness)),
    ];
    let help = help.map(|number| if short { number } else { String::new() });
    let figures = [
        html::part(&part.id),
        node.to_string(),
        format!("{:+.1}", fold.to_degrees()),
        format!("{radius:.0}"),
        format!("{ratio:.0}"),
        format!("<span class=\"{class}\">{word}</span>"),
    ];
    Some(figures.into_iter().chain(help).collect())
}

/// How much shorter a sheet becomes that is bent to the least hot radius instead of folded
/// sharply, its middle plane kept: 2 R tan(κ/2) − R κ (docs/formulas.md §2.5).
fn allowance(fold: f64, thickness: f64) -> f64 {
    let middle = (HEATED + 0.5) * thickness;
    let half = fold.abs() / 2.0;
    2.0 * middle * (trig::sin(half) / trig::cos(half) - half)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_right_angle_in_three_millimetres_takes_what_the_formula_says() {
        // R = 7.5: 2 × 7.5 × tan 45° − 7.5 × π / 2.
        let taken = allowance(std::f64::consts::FRAC_PI_2, 3.0);
        assert!((taken - (15.0 - 7.5 * std::f64::consts::FRAC_PI_2)).abs() < 1e-12);
    }
}
