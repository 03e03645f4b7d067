//! A verdict as JSON (contract §4).

use crate::joint::Joint;
use crate::rigidity::amplify::Bracket;
use crate::rigidity::paper::{Discrepancy, Paper};
use crate::rigidity::remedy::{Cure, Remedy};
use crate::rigidity::verdict::{Outcome, Verdict};
use crate::tolerance::ROUNDING;
use serde_json::{Map, Value, json};

/// Six significant digits: the last ones of a sum differ between processors.
fn six(value: f64) -> Value {
    if !value.is_finite() {
        return Value::Null;
    }
    if value.abs() < ROUNDING {
        return json!(0.0);
    }
    json!(format!("{value:.5e}").parse::<f64>().unwrap_or(value))
}

fn bracket(bracket: Option<Bracket>, by: f64) -> Value {
    let bound = |of: fn(&Bracket) -> f64| {
        bracket.as_ref().map_or(Value::Null, |b| six(of(b) * by))
    };
    json!({"lower": bound(|b| b.lower), "upper": bound(|b| b.upper)})
}

impl Verdict {
    /// As `rigidity --json` prints it; `per_hinge` adds the list of all hinges.
    pub fn json(&self, joint: impl Into<Option<Joint>>, per_hinge: bool) -> Value {
        // A mechanism sways without end: there is no number for it.
        let sway = self.sway.as_ref().filter(|_| self.outcome() != Outcome::Mechanism);
        let amplification = sway.map(|sway| sway.bracket);
        let direction = sway.map(|sway| sway.direction.iter().map(|x| six(*x)).collect());
        let spectrum: Vec<Value> = self.spectrum.iter().map(|s| six(*s)).collect();
        let still = Bracket { lower: 0.0, upper: 0.0 };
        let moves = self.outcome() == Outcome::Mechanism || sway.is_some();
        let amplification = if moves { amplification } else { Some(still) };
        let stiff =
            if moves { self.stiff.filter(|_| sway.is_some()) } else { Some(still) };
        json!({
            "joint": joint.into().map(Joint::name),
            "bodies": self.bodies.len(),
            "pins": self.pins,
            "mobility": self.mobility,
            "paper": self.paper.as_ref().map(|paper| paper_json(paper, per_hinge)),
            "spectrum": spectrum,
            "play_mm": six(self.play_mm),
            "amplification": bracket(amplification, 1.0),
            "amplification_stiff": bracket(stiff, 1.0),
            "sway_mm": bracket(amplification, self.play_mm),
            "sway_limit_mm": sway.map(|sway| six(sway.limit_mm)),
            "node": sway.map(|sway| sway.node).or(self.loose),
            "direction": direction.map(Value::Array),
            "play_to_pass_mm": self.play_to_pass().filter(|_| sway.is_some()).map(six),
            "verdict": self.outcome().name(),
            "remedies": self.remedies.iter().map(remedy).collect::<Vec<_>>(),
            "fingerprint": self.fingerprint().digits(),
        })
    }
}

fn paper_json(paper: &Paper, per_hinge: bool) -> Value {
    let values = || paper.discrepancies.iter().map(|d| d.value);
    let count = paper.discrepancies.len().max(1) as f64;
    let mean = values().sum::<f64>() / count;
    let rms = (values().map(|v| v * v).sum::<f64>() / count).sqrt();
    let mut discrepancy = Map::new();
    discrepancy.insert("max".into(), six(values().fold(0.0, f64::max)));
    discrepancy.insert("mean".into(), six(mean));
    discrepancy.insert("rms".into(), six(rms));
    if per_hinge {
        let all = paper.discrepancies.iter().map(hinge).collect();
        discrepancy.insert("per_hinge".into(), Value::Array(all));
    }
    let sigma: Vec<Value> = paper.singular_values.iter().map(|s| six(*s)).collect();
    json!({
        "fixed_body": 0,
        "pairing": paper.pairing.name(),
        "scale": six(paper.scale),
        "singular_values": sigma,
        "largest_singular_value": six(paper.largest),
        "discrepancy": discrepancy,
    })
}

fn hinge(d: &Discrepancy) -> Value {
    json!({"node": d.node, "bodies": d.bodies, "value": six(d.value)})
}

fn remedy(remedy: &Remedy) -> Value {
    let (kind, bodies) = match remedy.cure {
        Cure::Weld(bodies) => ("weld", bodies.to_vec()),
        Cure::Fix => ("fix", Vec::new()),
    };
    json!({
        "kind": kind,
        "node": remedy.node,
        "bodies": bodies,
        "amplification_after": remedy.amplification_after.map(six),
        "mobility_after": remedy.mobility_after,
        "passes": remedy.passes,
    })
}
