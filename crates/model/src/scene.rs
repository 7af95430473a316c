//! Pictures of mechanisms: the only thing that drawings see. Coordinates in metres, y upwards.

use forcewright_base::units::Unit;

/// What a line shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The shape as made.
    Undeformed,
    /// The shape under load.
    Deformed,
    /// The undeformed shape of a copy that follows from the layout.
    UndeformedCopy,
    /// The deformed shape of such a copy.
    DeformedCopy,
    /// A rigid part under load.
    Rigid,
    /// A rigid part of a copy that follows from the layout, under load.
    RigidCopy,
    /// A construction line: mirror, wall.
    Construction,
    /// The box in which the mechanism has to stay.
    Envelope,
    /// A plane of a layout, seen along the load: the drawn one.
    Plane,
    /// The same of a copy.
    PlaneCopy,
    /// A thing with a look and a word of its own, for the legend.
    Named(Look, &'static str),
}

/// How a named thing is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// A solid that stays where it is: grey, edged.
    Plate,
    /// What is cut out of a solid: paper-coloured, edged as that.
    Opening,
    /// A solid that moves: paper-coloured, with a thick edge.
    Moving,
    /// A bar that moves: grey with edges along it.
    Bar,
    /// A guide: a thin solid line.
    Rail,
    /// An axis: dash-dotted.
    Axis,
    /// The way of a point: dashed.
    Track,
    /// A spring or a cable: a solid line.
    Wire,
    /// Values drawn as lines across another line.
    Comb,
    /// What such a value must not pass: dashed, in the colour of limits.
    Limit,
}

/// How a point is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SupportKind {
    /// Position and rotation fixed.
    Clamped,
    /// Position fixed, free to rotate.
    Pinned,
    /// Free to move in any direction, rotation fixed.
    Parallel,
    /// Free to move along a direction (unit vector); rotation fixed or free.
    Slider {
        /// Direction of motion.
        direction: [f64; 2],
        /// Whether it may rotate.
        rotates: bool,
    },
}

/// One thing drawn.
#[derive(Clone, Debug)]
pub enum Item {
    /// A curve with a thickness, coloured by `values` at its points where given.
    Line {
        /// Points, m.
        points: Vec<[f64; 2]>,
        /// Thickness, m.
        width_m: f64,
        /// What it shows.
        role: Role,
        /// One value per point, on the scene's colour scale.
        values: Option<Vec<f64>>,
    },
    /// A rigid body: a closed polygon, m.
    Body {
        /// Corners, m.
        corners: Vec<[f64; 2]>,
        /// Whether it is drawn as made or under load.
        role: Role,
    },
    /// A round body.
    Disc {
        /// Its middle, m.
        centre: [f64; 2],
        /// Its radius, m.
        radius_m: f64,
        /// What it shows.
        role: Role,
    },
    /// A support symbol.
    Support {
        /// Where, m.
        at: [f64; 2],
        /// Which.
        kind: SupportKind,
        /// Unit vector from the mechanism into the ground, for the symbol's orientation.
        outward: [f64; 2],
    },
    /// A hinge: beams turn about this point.
    Hinge {
        /// Where, m.
        at: [f64; 2],
    },
    /// An arrow with a text, for forces and motions.
    Arrow {
        /// Tail, m.
        from: [f64; 2],
        /// Head, m.
        to: [f64; 2],
        /// Text.
        label: String,
    },
    /// A text beside a point.
    Label {
        /// Where, m.
        at: [f64; 2],
        /// Text.
        text: String,
    },
    /// A marked point with a text: the place of the largest stress.
    Marker {
        /// Where, m.
        at: [f64; 2],
        /// Text.
        label: String,
    },
}

/// What colours mean.
#[derive(Clone, Debug)]
pub struct ColourScale {
    /// Name of the quantity: `|σ|`.
    pub label: String,
    /// The unit in which it is shown.
    pub display: Unit,
    /// Value at the scale's end, SI; the scale starts at zero.
    pub max: f64,
    /// A limit to mark on the scale, SI, with its name.
    pub limit: Option<(f64, String)>,
}

/// A picture of a mechanism.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Things drawn, back to front.
    pub items: Vec<Item>,
    /// What the colours of [`Item::Line`] values mean.
    pub scale: Option<ColourScale>,
    /// What the legend calls the shapes drawn as [`Role::Undeformed`] and as [`Role::Deformed`].
    pub words: [&'static str; 2],
    /// The unit of the scale bar.
    pub display: Unit,
    /// A description for people who cannot see it.
    pub description: String,
}
