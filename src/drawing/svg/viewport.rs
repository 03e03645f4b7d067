//! How large an SVG is: units, `viewBox`, and how one is fitted into the other (SVG 1.1 §7).

use crate::drawing::Reading;
use nalgebra::Matrix3;
use roxmltree::Node;
use svgtypes::{Align, AspectRatio, Length, LengthUnit, ViewBox};

const MM_PER_INCH: f64 = 25.4;
/// User units in `1em` and `1ex`, as browsers have them.
const EM: f64 = 16.0;

/// The outermost viewport.
pub(super) struct Page {
    /// From user units to millimetres with y upward.
    pub(super) matrix: Matrix3<f64>,
    /// Width and height in user units.
    pub(super) viewport: [f64; 2],
    /// Whether the file, or who reads it, says how large a user unit is.
    pub(super) says_unit: bool,
}

/// The page of the whole drawing.
pub(super) fn page(root: Node, reading: &Reading) -> Page {
    let length = |name: &str| root.attribute(name)?.trim().parse::<Length>().ok();
    let sizes = [length("width"), length("height")];
    let mm = |length: Length| {
        let user = MM_PER_INCH / reading.dpi;
        match length.unit {
            LengthUnit::Percent => None,
            LengthUnit::None | LengthUnit::Px => Some(length.number * user),
            LengthUnit::Em => Some(length.number * EM * user),
            LengthUnit::Ex => Some(length.number * EM / 2.0 * user),
            unit => Some(length.number * millimetres(unit)),
        }
        .filter(|mm| *mm > 0.0)
    };
    let view = view_box(root);
    let mut size = sizes.map(|length| length.and_then(mm));
    let mut user = MM_PER_INCH / reading.dpi;
    if let Some(unit) = reading.millimetres {
        user = unit;
        size = view.map_or([None; 2], |v| [v.w, v.h].map(|side| Some(side * unit)));
    }
    let fitted = fitted(view, size, user, ratio(root));
    let height = size[1].or(view.map(|v| v.h * fitted[(1, 1)])).unwrap_or(0.0);
    let upward = Matrix3::new(1.0, 0.0, 0.0, 0.0, -1.0, height, 0.0, 0.0, 1.0);
    let of_view = view.map(|view| [view.w, view.h]);
    let of_size = || size.map(|mm| mm.map_or(100.0, |mm| mm / user));
    let absolute = |length: Option<Length>| {
        use LengthUnit::{Cm, In, Mm, Pc, Pt};
        length.is_some_and(|length| matches!(length.unit, Mm | Cm | In | Pt | Pc))
    };
    Page {
        matrix: upward * fitted,
        viewport: of_view.unwrap_or_else(of_size),
        says_unit: reading.millimetres.is_some() || sizes.into_iter().any(absolute),
    }
}

/// From the coordinates inside a nested `svg`, or a `symbol` drawn by `user`, to those around
/// it; and the size of what is inside.
pub(super) fn nested(
    node: Node,
    user: Option<Node>,
    around: [f64; 2],
    reading: &Reading,
) -> (Matrix3<f64>, [f64; 2]) {
    let length = |name: &str, axis: usize| {
        let of = |node| length(node, name, around[axis], reading);
        user.and_then(of).or_else(|| of(node))
    };
    let [x, y] = [("x", 0), ("y", 1)].map(|(name, axis)| {
        let is_own = user.is_none();
        is_own.then(|| length(name, axis)).flatten().unwrap_or(0.0)
    });
    let size = [length("width", 0), length("height", 1)];
    let view = view_box(node);
    // Without a size it is as large as what is around it.
    let whole = [0, 1].map(|axis| Some(size[axis].unwrap_or(around[axis])));
    let fitted = fitted(view, whole, 1.0, ratio(node));
    let moved = Matrix3::new(1.0, 0.0, x, 0.0, 1.0, y, 0.0, 0.0, 1.0);
    let inside = view.map_or(whole.map(|side| side.unwrap_or(0.0)), |v| [v.w, v.h]);
    (moved * fitted, inside)
}

fn view_box(node: Node) -> Option<ViewBox> {
    let view: ViewBox = node.attribute("viewBox")?.parse().ok()?;
    (view.w > 0.0 && view.h > 0.0).then_some(view)
}

fn ratio(node: Node) -> AspectRatio {
    let text = node.attribute("preserveAspectRatio");
    let parsed = text.and_then(|text| text.parse().ok());
    parsed.unwrap_or(AspectRatio { defer: false, align: Align::XMidYMid, slice: false })
}

/// The `viewBox` in a viewport of this size, y downward; `user` is the size of a user unit
/// where nothing says it.
fn fitted(
    view: Option<ViewBox>,
    size: [Option<f64>; 2],
    user: f64,
    ratio: AspectRatio,
) -> Matrix3<f64> {
    let Some(view) = view else { return Matrix3::new_scaling(user) };
    let scales = [size[0].map(|w| w / view.w), size[1].map(|h| h / view.h)];
    let one = match scales {
        [Some(x), Some(y)] if ratio.slice => x.max(y),
        [Some(x), Some(y)] => x.min(y),
        [x, y] => x.or(y).unwrap_or(user),
    };
    let is_kept = ratio.align != Align::None;
    let [sx, sy] = scales.map(|scale| if is_kept { one } else { scale.unwrap_or(one) });
    let (x, y) = shares(ratio.align);
    let left = |side: Option<f64>, used: f64, share: f64| {
        side.map_or(0.0, |side| (side - used) * share)
    };
    let tx = left(size[0], view.w * sx, x) - sx * view.x;
    let ty = left(size[1], view.h * sy, y) - sy * view.y;
    Matrix3::new(sx, 0.0, tx, 0.0, sy, ty, 0.0, 0.0, 1.0)
}

/// Shares of the space left over that lie before what is fitted.
fn shares(align: Align) -> (f64, f64) {
    use Align::{None, XMaxYMax, XMaxYMid, XMaxYMin, XMidYMax, XMidYMid, XMidYMin};
    use Align::{XMinYMax, XMinYMid, XMinYMin};
    match align {
        None | XMinYMin => (0.0, 0.0),
        XMidYMin => (0.5, 0.0),
        XMaxYMin => (1.0, 0.0),
        XMinYMid => (0.0, 0.5),
        XMidYMid => (0.5, 0.5),
        XMaxYMid => (1.0, 0.5),
        XMinYMax => (0.0, 1.0),
        XMidYMax => (0.5, 1.0),
        XMaxYMax => (1.0, 1.0),
    }
}

const fn millimetres(unit: LengthUnit) -> f64 {
    match unit {
        LengthUnit::Cm => 10.0,
        LengthUnit::In => MM_PER_INCH,
        LengthUnit::Pt => MM_PER_INCH / 72.0,
        LengthUnit::Pc => MM_PER_INCH / 6.0,
        _ => 1.0,
    }
}

/// An attribute's length in user units; percentages are of `whole`.
pub(super) fn length(
    node: Node,
    name: &str,
    whole: f64,
    reading: &Reading,
) -> Option<f64> {
    let length: Length = node.attribute(name)?.trim().parse().ok()?;
    Some(match length.unit {
        LengthUnit::None | LengthUnit::Px => length.number,
        LengthUnit::Em => length.number * EM,
        LengthUnit::Ex => length.number * EM / 2.0,
        LengthUnit::Percent => length.number / 100.0 * whole,
        unit => length.number * millimetres(unit) * reading.dpi / MM_PER_INCH,
    })
}

/// Lengths of one shape.
pub(super) struct Lengths<'a, 'b, 'input> {
    pub(super) node: Node<'b, 'input>,
    pub(super) place: [f64; 2],
    pub(super) reading: &'a Reading<'a>,
}

impl Lengths<'_, '_, '_> {
    /// By its name, which says what percentages are of.
    pub(super) fn of(&self, name: &str) -> Option<f64> {
        let [w, h] = self.place;
        let whole = match name {
            "x" | "x1" | "x2" | "cx" | "rx" | "width" => w,
            "y" | "y1" | "y2" | "cy" | "ry" | "height" => h,
            _ => (w * w + h * h).sqrt() / std::f64::consts::SQRT_2,
        };
        length(self.node, name, whole, self.reading)
    }
}
