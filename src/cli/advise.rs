//! `check --advise`: which scale a template can make.

use crate::cli::console::{Console, Terminal};
use crate::cli::flags::structure::InputArgs;
use crate::cli::input;
use crate::cli::outcome::{End, Failure, print};
use crate::job::{Advice, Question, Tried, smallest_scale};

/// Looks for the smallest scale and prints what was tried.
pub(super) fn run(args: &InputArgs, console: Console) -> Result<End, Failure> {
    let settings = input::settings(args)?;
    let draft = input::structure(args)?.draft;
    let mut terminal = Terminal::new(console, None);
    let depth = args.depth.map(|depth| [depth.below, depth.above]);
    let question = Question { draft: &draft, settings: &settings, depth };
    let advice = smallest_scale(&question, &mut terminal);
    terminal.finish();
    let advice = advice?;
    let scale = |factor: f64| 1.0 / (args.scale.factor * factor);
    if args.json {
        print(&format!("{}\n", json(&advice, scale)));
    } else {
        print(&table(&advice, scale));
    }
    console.say(&match advice.least() {
        Some(factor) => format!(
            "smallest scale that passes: 1:{}, {factor:.2} times the one given",
            number(scale(factor))
        ),
        None => "no scale up to a hundred times the one given passes".to_owned(),
    });
    Ok(if advice.least().is_some() { End::Done } else { End::Refused })
}

/// The N of 1:N, rounded down: a larger model than the one that passed.
fn number(n: f64) -> String {
    let decimals = if n >= 100.0 {
        0
    } else if n >= 10.0 {
        1
    } else {
        3
    };
    let power = [1.0, 10.0, 100.0, 1000.0][decimals];
    format!("{}", (n * power).floor() / power)
}

fn failing(tried: &Tried) -> String {
    let codes = tried.fails.iter().map(|(code, (count, _))| format!("{code} ({count})"));
    let codes: Vec<String> = codes.collect();
    if codes.is_empty() { "passes".to_owned() } else { codes.join(", ") }
}

fn table(advice: &Advice, scale: impl Fn(f64) -> f64) -> String {
    let mut text = format!("{:>10}  {:>7}  what fails\n", "scale", "times");
    for tried in &advice.tried {
        let name = format!("1:{}", number(scale(tried.factor)));
        text += &format!("{name:>10}  {:>7.3}  {}\n", tried.factor, failing(tried));
    }
    for (_, finding) in advice.binding().iter().flat_map(|tried| tried.fails.values()) {
        text += &format!("binds: {}\n", finding.message);
    }
    text
}

fn json(advice: &Advice, scale: impl Fn(f64) -> f64) -> serde_json::Value {
    let tried = advice.tried.iter().map(|tried| {
        serde_json::json!({
            "scale": format!("1:{}", number(scale(tried.factor))),
            "factor": tried.factor,
            "fails": tried.fails.iter().map(|(code, (count, first))| {
                serde_json::json!({"code": code, "count": count, "first": first})
            }).collect::<Vec<_>>(),
        })
    });
    let least = advice.least().map(|factor| {
        serde_json::json!({"scale": format!("1:{}", number(scale(factor))), "factor": factor})
    });
    serde_json::json!({"tried": tried.collect::<Vec<_>>(), "smallest": least})
}
