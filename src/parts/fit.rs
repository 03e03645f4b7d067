//! What the sheet material and the joint ask of a part.

/// Lengths in mm, angles in radians. From a template.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Measured sheet thickness.
    pub thickness: f64,
    /// Added to the thickness of what a slit receives.
    pub clearance: f64,
    /// Remaining material that is warned of below this.
    pub web: f64,
    /// Remaining material that is refused below this.
    pub web_least: f64,
    /// Radius of the rounded corners at a slit's end.
    pub relief: f64,
    /// Material past the slit at a strip's end.
    pub overhang: f64,
    /// Share of the height that is cut from the top.
    pub lap_split: f64,
    /// How much deeper than the split a slit goes.
    pub depth_allowance: f64,
    /// How deep a slit's mouth is flared.
    pub chamfer: f64,
    /// How far each side of the mouth flares.
    pub chamfer_angle: f64,
    /// Extra gap of a strip end that is set back.
    pub setback: f64,
    /// Thickness of a disc or eye plate.
    pub connector_thickness: f64,
    /// Diameter of the rod through a connector.
    pub rod_diameter: f64,
    /// Length of a disc's windows, and of a lap with an eye plate, where there is room.
    pub disc_slot: f64,
    /// Angle between neighbouring fins of a connector that is refused below this.
    pub fin_angle_least: f64,
    /// Crossing angle that is warned of below this.
    pub crossing_warn: f64,
    /// Crossing angle that is refused below this.
    pub crossing_least: f64,
    /// Bend limits as radius over thickness: warned of below the first, refused below
    /// the second.
    pub bend_model: f64,
    /// See [`Fit::bend_model`].
    pub bend_crack: f64,
}

impl Fit {
    /// How far from the axis a fin stays clear of another one at the angle `between`
    /// (0, π) to it, both as thick as the sheet.
    pub fn clear_distance(&self, between: f64) -> f64 {
        crate::parts::setback::clear_of(self.thickness, self.thickness, between)
    }

    /// Half the clearance: what a plate has on each side of its cut.
    pub fn gap(&self) -> f64 {
        self.clearance.max(0.0) / 2.0
    }

    /// How far a plate reaches into the rounded end of its cut before its corners touch.
    pub fn bite(&self) -> f64 {
        let radius = self.relief.min((self.thickness + self.clearance) / 2.0);
        (2.0 * radius * self.gap() - self.gap() * self.gap()).max(0.0).sqrt()
    }

    /// Half the thickness of a strip with this kink, seen along the fins that cross it.
    pub fn kinked_half(&self, kink: f64) -> f64 {
        self.thickness / (2.0 * crate::geometry::trig::cos(kink / 2.0))
    }
}
