//! What a case wants drawn, as data: reports draw it without knowing any solver.

use crate::raster::Raster;
use serde::{Deserialize, Serialize};

/// One axis of a graph.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Quantity and unit, such as `time t (s)`.
    pub label: String,
    /// Logarithmic when true; points that are not positive are left out by the drawer, and counted.
    pub logarithmic: bool,
}

impl Axis {
    /// An even axis.
    #[must_use]
    pub fn linear(label: &str) -> Self {
        Self { label: label.to_owned(), logarithmic: false }
    }

    /// A logarithmic axis.
    #[must_use]
    pub fn log(label: &str) -> Self {
        Self { label: label.to_owned(), logarithmic: true }
    }
}

/// How a curve is drawn. Colour follows the order of the curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stroke {
    /// A solid line.
    Line,
    /// A dashed line: exact answers, limits.
    Dashed,
    /// Separate markers: measured points.
    Markers,
    /// Markers joined by a line: levels of resolution.
    MarkedLine,
    /// Small hollow markers in the look of the curve before it: points that its line passes by.
    Beside,
    /// Crosses in the look of the curve before it: runs that failed.
    Failed,
    /// Pale bars from each point to the next but one, two points a bar: floors, ranges.
    Bars,
}

/// One curve of a graph.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Name in the legend.
    pub label: String,
    /// How it is drawn.
    pub stroke: Stroke,
    /// Points (x, y) in the units of the axes.
    pub points: Vec<(f64, f64)>,
}

impl Curve {
    /// A curve with a name.
    #[must_use]
    pub fn new(label: impl Into<String>, stroke: Stroke, points: Vec<(f64, f64)>) -> Self {
        Self { label: label.into(), stroke, points }
    }
}

/// A graph with axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Graph {
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Curves in the order in which they are drawn.
    pub curves: Vec<Curve>,
}

/// One contact of a force plot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ForceBar {
    /// Ends of the bar (m), grain centre to grain centre or to the wall.
    pub from: [f64; 2],
    /// Other end (m).
    pub to: [f64; 2],
    /// Magnitude of the contact force (N); the width is proportional to it.
    pub force: f64,
    /// Whether the contact slips.
    pub slipping: bool,
}

/// Cundall and Strack's force plot: rectangles along contacts, width proportional to force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ForcePlot {
    /// Centre (m) and radius (m) of every disc, and its angle of rotation (rad).
    pub discs: Vec<([f64; 2], f64, f64)>,
    /// Walls as pairs of end points (m), already cut to the drawing.
    pub walls: Vec<([f64; 2], [f64; 2])>,
    /// The contacts.
    pub bars: Vec<ForceBar>,
}

/// Lines of one kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lines {
    /// What they are, in the legend.
    pub label: String,
    /// Both ends of each, and its width as a part of the widest that there can be.
    pub lines: Vec<([f64; 2], [f64; 2], f64)>,
}

/// A part of the plane with lines in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sheet {
    /// What stands above it.
    pub title: String,
    /// Lower and upper corner of what is seen.
    pub seen: [[f64; 2]; 2],
    /// Lower and upper corner of a part that is marked.
    pub marked: Option<[[f64; 2]; 2]>,
    /// The lines, in the order in which they are drawn; a kind has the same place in all sheets, and may be empty.
    pub kinds: Vec<Lines>,
}

/// Sheets with lines beside one another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LinePlot {
    /// Labels of the horizontal and of the vertical axis.
    pub axes: [String; 2],
    /// Whether both axes have one scale, so that angles are what they are.
    pub to_scale: bool,
    /// The sheets.
    pub sheets: Vec<Sheet>,
}

/// How the values of a field are coloured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Shades {
    /// From dark to light on white: amounts.
    Amount,
    /// From black to light on black: what glows, such as stress between crossed polarisers.
    Glow,
    /// Two colours that meet in the middle of the range: signed values.
    Signed,
    /// Grey: fringes.
    Fringes,
    /// From dark to light, each colour in shades from dark to bright: amounts on lit bodies. Levels are those of
    /// [`crate::raster::lit`].
    Lit,
}

/// One picture of a field, or the frames of a film of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Panel {
    /// What stands above it.
    pub title: String,
    /// Frames in the order of the times of the field; all of one size.
    pub frames: Vec<Raster>,
    /// Values of its lowest and its highest level and their unit, where it does not share those of the field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub own: Option<((f64, f64), String)>,
}

/// A field over the plane, in panels beside one another that share colours, and a scale unless they have their own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Field {
    /// Quantity, such as `σ₁ − σ₂`.
    pub label: String,
    /// Its SI unit; `1` for a pure number.
    pub unit: String,
    /// Values of the lowest and the highest level.
    pub range: (f64, f64),
    /// How they are coloured.
    pub shades: Shades,
    /// Side of a pixel, in the unit of lengths; zero where they have none.
    pub pixel: f64,
    /// Unit of lengths: `m`, or what a scene without units counts them in, such as a diameter `d`.
    pub length: String,
    /// The panels, equally large.
    pub panels: Vec<Panel>,
    /// What the frames of a film are told apart by, such as `time t (s)`.
    pub clock: String,
    /// Where each frame stands on that clock; one for a picture.
    pub times: Vec<f64>,
}

/// What is drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Drawing {
    /// Curves over two axes.
    Graph(Graph),
    /// A force plot.
    Forces(ForcePlot),
    /// A field, as pictures or as a film.
    Field(Field),
    /// Lines in the plane.
    Lines(LinePlot),
}

/// One figure of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// File name without extension, unique within the case: letters, digits and `-`.
    pub name: String,
    /// Short title.
    pub title: String,
    /// What the reader sees and what it means, in a sentence or two.
    pub caption: String,
    /// The drawing.
    pub drawing: Drawing,
}

impl Figure {
    /// A graph.
    #[must_use]
    pub fn graph(name: &str, title: &str, caption: &str, [x, y]: [Axis; 2], curves: Vec<Curve>) -> Self {
        Self {
            name: name.to_owned(),
            title: title.to_owned(),
            caption: caption.to_owned(),
            drawing: Drawing::Graph(Graph { x, y, curves }),
        }
    }
    /// A field.
    #[must_use]
    pub fn field(name: &str, title: &str, caption: &str, field: Field) -> Self {
        Self {
            name: name.to_owned(),
            title: title.to_owned(),
            caption: caption.to_owned(),
            drawing: Drawing::Field(field),
        }
    }

    /// Lines in the plane.
    #[must_use]
    pub fn lines(name: &str, title: &str, caption: &str, plot: LinePlot) -> Self {
        Self {
            name: name.to_owned(),
            title: title.to_owned(),
            caption: caption.to_owned(),
            drawing: Drawing::Lines(plot),
        }
    }

    /// Cundall and Strack's force plot.
    #[must_use]
    pub fn forces(name: &str, title: &str, caption: &str, plot: ForcePlot) -> Self {
        Self {
            name: name.to_owned(),
            title: title.to_owned(),
            caption: caption.to_owned(),
            drawing: Drawing::Forces(plot),
        }
    }
}
