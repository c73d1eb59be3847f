//! Figures of cases as data. Reports plot them without using any solver.

use crate::raster::Raster;
use serde::{Deserialize, Deserializer, Serialize};

/// Number of a stored figure. JSON stores numbers that are not finite as `null`, which is read as NaN; plots leave such points
/// out and state their number.
#[derive(Deserialize)]
#[serde(from = "Option<f64>")]
struct Number(f64);

impl From<Option<f64>> for Number {
    fn from(number: Option<f64>) -> Self {
        Self(number.unwrap_or(f64::NAN))
    }
}

/// Reads a number; `null` is read as NaN.
///
/// # Errors
/// When the value is neither a number nor `null`.
pub fn number<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Number::deserialize(from).map(|number| number.0)
}

fn pair([x, y]: [Number; 2]) -> [f64; 2] {
    [x.0, y.0]
}

fn point<'de, D: Deserializer<'de>>(from: D) -> Result<[f64; 2], D::Error> {
    Deserialize::deserialize(from).map(pair)
}

fn points<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<(f64, f64)>, D::Error> {
    Ok(Vec::deserialize(from)?.into_iter().map(|point| pair(point).into()).collect())
}

/// Centre, radius and angle of a disc.
type Disc = ([f64; 2], f64, f64);
/// End points of a wall.
type Segment = ([f64; 2], [f64; 2]);

fn discs<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Disc>, D::Error> {
    let discs: Vec<([Number; 2], Number, Number)> = Vec::deserialize(from)?;
    Ok(discs.into_iter().map(|(centre, radius, angle)| (pair(centre), radius.0, angle.0)).collect())
}

fn walls<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Segment>, D::Error> {
    Ok(Vec::deserialize(from)?.into_iter().map(|(a, b)| (pair(a), pair(b))).collect())
}

/// One axis of a graph.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[must_use]
pub struct Axis {
    /// Quantity and unit, such as `time t (s)`.
    pub label: String,
    /// True for a logarithmic axis. The plot leaves out points that are not positive, and states their number.
    pub logarithmic: bool,
}

impl Axis {
    /// Returns a linear axis.
    pub fn linear(label: &str) -> Self {
        Self { label: label.to_owned(), logarithmic: false }
    }

    /// Returns a logarithmic axis.
    pub fn log(label: &str) -> Self {
        Self { label: label.to_owned(), logarithmic: true }
    }
}

/// Line style of a curve. The colour follows from the solver named in the label, or from the order of the curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stroke {
    /// A solid line.
    Line,
    /// A dashed line, for exact solutions and limits.
    Dashed,
    /// Separate markers, for measured points.
    Markers,
    /// Markers joined by a line, for resolution levels.
    MarkedLine,
    /// Small hollow markers in the style of the previous curve, for points off its line.
    Beside,
    /// Crosses in the style of the previous curve, for failed runs.
    Failed,
    /// Pale bars, for floors and ranges. Each pair of points gives the two ends of a bar.
    Bars,
}

/// One curve of a graph.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Label in the legend.
    pub label: String,
    /// Line style.
    pub stroke: Stroke,
    /// Points (x, y) in the units of the axes.
    #[serde(deserialize_with = "points")]
    pub points: Vec<(f64, f64)>,
}

impl Curve {
    /// Returns a curve with a label.
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
    /// Curves in drawing order.
    pub curves: Vec<Curve>,
}

/// One contact of a force plot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ForceBar {
    /// First end of the bar (m).
    #[serde(deserialize_with = "point")]
    pub from: [f64; 2],
    /// Second end of the bar (m).
    #[serde(deserialize_with = "point")]
    pub to: [f64; 2],
    /// Magnitude of the contact force (N). The width of the bar is proportional to it.
    #[serde(deserialize_with = "number")]
    pub force: f64,
    /// True if the contact slips.
    pub slipping: bool,
}

/// Force plot of Cundall and Strack. A bar at each contact has the direction of the contact force, and a width
/// proportional to its magnitude.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ForcePlot {
    /// Centre (m), radius (m) and angle of rotation (rad; NaN if unknown) of every disc.
    #[serde(deserialize_with = "discs")]
    pub discs: Vec<([f64; 2], f64, f64)>,
    /// Pairs of end points of the walls (m), clipped to the drawing.
    #[serde(deserialize_with = "walls")]
    pub walls: Vec<([f64; 2], [f64; 2])>,
    /// Force bars, one for each contact.
    pub bars: Vec<ForceBar>,
}

/// Group of lines with one entry in the legend.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lines {
    /// Label in the legend.
    pub label: String,
    /// Both ends of each line, and its width as a fraction of the largest possible width.
    pub lines: Vec<([f64; 2], [f64; 2], f64)>,
}

/// Lines in a rectangle of a plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sheet {
    /// Title above the rectangle.
    pub title: String,
    /// Lower left and upper right corner of the visible rectangle.
    pub seen: [[f64; 2]; 2],
    /// Lower left and upper right corner of a rectangle drawn as a frame.
    pub marked: Option<[[f64; 2]; 2]>,
    /// Groups of lines in drawing order. A group has the same index in all sheets, and may be empty.
    pub kinds: Vec<Lines>,
}

/// Several sheets with lines, side by side.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LinePlot {
    /// Labels of the horizontal and of the vertical axis.
    pub axes: [String; 2],
    /// True if both axes have the same scale, so that angles are preserved.
    pub to_scale: bool,
    /// Rectangles from left to right.
    pub sheets: Vec<Sheet>,
}

/// Colour map of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Shades {
    /// From dark to light on white, for amounts.
    Amount,
    /// From black to light on a black background, for light intensity such as stress between crossed polarisers.
    Glow,
    /// Two colours that meet at the middle of the range, for signed values.
    Signed,
    /// Grey, for fringes.
    Fringes,
    /// Several colours from dark to light, each in shades from dark to bright, for amounts on shaded bodies.
    /// [`crate::raster::lit`] computes the levels.
    Lit,
}

/// Picture of a field, or the frames of a film of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Panel {
    /// Title above the panel.
    pub title: String,
    /// Frames at the times of the field. All have the same size.
    pub frames: Vec<Raster>,
    /// Values of the lowest and the highest level, and their unit; none to use range and unit of the field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub own: Option<((f64, f64), String)>,
}

/// Field over a plane, in one or more panels. All panels share the colour map, and the scale unless a panel has its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Field {
    /// Quantity, such as `σ₁ − σ₂`.
    pub label: String,
    /// SI unit; `1` for a pure number.
    pub unit: String,
    /// Values of the lowest and the highest level.
    pub range: (f64, f64),
    /// Colour map.
    pub shades: Shades,
    /// Side of a pixel, in the unit of length; 0 if coordinates have no unit.
    pub pixel: f64,
    /// Unit of length: `m`, or the length scale of a scene without units, such as a diameter `d`.
    pub length: String,
    /// Panels, all of the same size.
    pub panels: Vec<Panel>,
    /// Label of the time axis of a film, such as `time t (s)`.
    pub clock: String,
    /// Value of each frame on the time axis. A single picture has one value.
    pub times: Vec<f64>,
}

/// Drawing of a figure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Drawing {
    /// Curves over two axes.
    Graph(Graph),
    /// A force plot.
    Forces(ForcePlot),
    /// A field, as a picture or as a film.
    Field(Field),
    /// Lines in the plane.
    Lines(LinePlot),
}

/// One figure of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[must_use]
pub struct Figure {
    /// File name without extension, unique within the case. It contains letters, digits and `-`.
    pub name: String,
    /// Short title.
    pub title: String,
    /// Description of the figure and of the expected result, in one or two sentences.
    pub caption: String,
    /// Curves, forces, field or lines.
    pub drawing: Drawing,
}

impl Figure {
    fn new(name: &str, title: &str, caption: &str, drawing: Drawing) -> Self {
        Self { name: name.to_owned(), title: title.to_owned(), caption: caption.to_owned(), drawing }
    }

    /// Returns a figure with a graph.
    pub fn graph(name: &str, title: &str, caption: &str, [x, y]: [Axis; 2], curves: Vec<Curve>) -> Self {
        Self::new(name, title, caption, Drawing::Graph(Graph { x, y, curves }))
    }

    /// Returns a figure with a field.
    pub fn field(name: &str, title: &str, caption: &str, field: Field) -> Self {
        Self::new(name, title, caption, Drawing::Field(field))
    }

    /// Returns a figure with lines in the plane.
    pub fn lines(name: &str, title: &str, caption: &str, plot: LinePlot) -> Self {
        Self::new(name, title, caption, Drawing::Lines(plot))
    }

    /// Returns a figure with a force plot of Cundall and Strack.
    pub fn forces(name: &str, title: &str, caption: &str, plot: ForcePlot) -> Self {
        Self::new(name, title, caption, Drawing::Forces(plot))
    }
}
