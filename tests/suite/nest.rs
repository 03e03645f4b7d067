//! The nester on parts that nobody would draw: each is placed or refused by its name, and
//! what is placed never overlaps.

use finwright::geometry::{Point2, trig};
use finwright::nest::{Effort, Shape, Stock, Turns, check, refused, search, strip};
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Numbers in 0 to 1, the same on every run (SplitMix64).
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn up_to(&mut self, count: usize) -> usize {
        (self.roll() * count as f64) as usize
    }
}

fn ring(centre: [f64; 2], radius: f64, corners: usize) -> Vec<Point2> {
    let corner = |k: usize| {
        let turn = TAU * k as f64 / corners as f64;
        Point2::new(
            centre[0] + radius * trig::cos(turn),
            centre[1] + radius * trig::sin(turn),
        )
    };
    (0..corners).map(corner).collect()
}

/// A needle, a comb, a star, a ring, a dented box; sometimes spoilt.
fn part(k: usize, dice: &mut Dice) -> Shape {
    let size = 5.0 + 120.0 * dice.roll();
    let mut holes = Vec::new();
    let mut outline = match dice.up_to(5) {
        0 => vec![
            Point2::origin(),
            Point2::new(size, 0.0),
            Point2::new(size, 1e-3 + 0.1 * dice.roll()),
        ],
        1 => {
            let teeth = 3 + dice.up_to(6);
            let pitch = size / teeth as f64;
            let tooth = |k: usize| {
                let x = pitch * k as f64;
                [[x, 20.0], [x, 5.0], [x + pitch / 2.0, 5.0], [x + pitch / 2.0, 20.0]]
            };
            let top = (0..teeth).rev().flat_map(|k| tooth(k).into_iter().rev());
            let base = [[0.0, 0.0], [size - pitch / 2.0, 0.0]];
            base.into_iter().chain(top).map(Point2::from).collect()
        }
        2 => {
            let points = 2 * (4 + dice.up_to(8));
            let mut star = ring([0.0; 2], size / 2.0, points);
            star.iter_mut().step_by(2).for_each(|p| *p *= 0.3);
            star
        }
        3 => {
            holes.push(ring([0.0; 2], 0.3 * size, 12));
            ring([0.0; 2], size / 2.0, 24)
        }
        _ => [[0.0, 0.0], [size, 0.0], [size / 2.0, 2.0], [size, 30.0], [0.0, 30.0]]
            .map(Point2::from)
            .to_vec(),
    };
    match dice.up_to(12) {
        0 => outline.push(outline[0]),
        1 => outline.insert(1, outline[0]),
        2 => outline.swap(0, 1),
        3 => outline.iter_mut().for_each(|p| *p *= 1e7),
        4 => outline[0].x = f64::NAN,
        5 => outline.truncate(2),
        6 => holes.push(ring([0.0; 2], 0.3 * size, 12)),
        7 => outline.iter_mut().for_each(|p| p.y = 0.0),
        8 => outline.iter_mut().for_each(|p| p.x += 9e5),
        _ => {}
    }
    let turns = match dice.up_to(3) {
        0 => Turns::Only(vec![0.0, TAU / 4.0]),
        _ => Turns::Free,
    };
    Shape { name: format!("P{k}"), outline, holes, turns }
}

#[test]
fn odd_parts_are_placed_or_refused_and_never_overlap() {
    let stock = [
        Stock { width: 300.0, height: 200.0, margin: 4.0, spacing: 1.5, count: Some(3) },
        Stock { width: 160.0, height: 90.0, margin: 4.0, spacing: 1.5, count: None },
    ];
    for seed in 0..40 {
        let mut dice = Dice(seed);
        let count = 1 + dice.up_to(30);
        let parts: Vec<Shape> = (0..count).map(|k| part(k, &mut dice)).collect();
        let (good, bad): (Vec<Shape>, Vec<Shape>) =
            parts.into_iter().partition(|part| refused(part).is_none());
        for part in &bad {
            let why = refused(part).expect("it was refused").to_string();
            assert!(why.contains(&part.name), "{why}");
        }
        let effort = Effort { trials: 3, seed };
        let found = search(&good, &stock, &effort, &mut ()).expect("a layout");
        assert_eq!(check(&found.layout, &good, &stock), [], "seed {seed}");
        let on = found.layout.sheets.iter().flat_map(|sheet| &sheet.placements);
        let on: Vec<usize> = on.map(|placement| placement.shape).collect();
        let once: BTreeSet<usize> = on.iter().copied().collect();
        assert_eq!(on.len(), once.len(), "seed {seed}: a part was placed twice");
        assert_eq!(on.len() + found.unplaced.len(), good.len(), "seed {seed}");
        let again = search(&good, &stock, &effort, &mut ()).expect("a layout");
        assert_eq!(found, again, "seed {seed}");
    }
}

/// One part too large for every sheet keeps nobody from searching for the rest.
#[test]
fn what_fits_no_sheet_is_named_and_the_rest_is_nested_densely() {
    let board = |name: String, width: f64| Shape {
        name,
        outline: [[0.0, 0.0], [width, 0.0], [width, 20.0], [0.0, 20.0]]
            .map(Point2::from)
            .to_vec(),
        holes: Vec::new(),
        turns: Turns::Free,
    };
    let stock =
        [Stock { width: 200.0, height: 100.0, margin: 2.0, spacing: 1.0, count: None }];
    let mut parts: Vec<Shape> = (0..8).map(|k| board(format!("B{k}"), 90.0)).collect();
    parts.insert(3, board("long".into(), 900.0));
    let effort = Effort { trials: 20, seed: 0 };
    let found = search(&parts, &stock, &effort, &mut ()).expect("a layout");
    assert!(found.unplaced[0].to_string().contains("long"));
    assert_eq!(found.layout.sheets.len(), 1);
    let on = &found.layout.sheets[0].placements;
    assert_eq!((on.len(), on.iter().any(|p| p.shape == 3)), (8, false));
    assert!(found.trials > 1, "there was no search");
}

/// Equal rectangles: the strip cannot be shorter than their area allows, and the search
/// comes close.
#[test]
fn a_strip_of_rectangles_is_nearly_full() {
    let board = |k: usize| Shape {
        name: format!("B{k}"),
        outline: [[0.0, 0.0], [40.0, 0.0], [40.0, 25.0], [0.0, 25.0]]
            .map(Point2::from)
            .to_vec(),
        holes: Vec::new(),
        turns: Turns::Only(vec![0.0, TAU / 4.0]),
    };
    let parts: Vec<Shape> = (0..16).map(board).collect();
    let sheet =
        Stock { width: 1.0, height: 101.0, margin: 0.0, spacing: 0.0, count: None };
    let found =
        strip(&parts, &sheet, &Effort { trials: 40, seed: 1 }, &mut ()).expect("a strip");
    assert!((160.0..176.0).contains(&found.length), "{}", found.length);
}
