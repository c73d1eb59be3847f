//! Reading of stored figures. Points of a diverged run may not be finite, and JSON stores them as `null`. They are read
//! as NaN; figures leave them out and state their number.

use grainbench_harness::figure::{Axis, Curve, Drawing, Field, Figure, ForceBar, ForcePlot, Graph, LinePlot, Stroke};
use serde::{Deserialize, Deserializer};

/// A number; `null` is read as NaN.
#[derive(Clone, Copy, Deserialize)]
#[serde(transparent)]
struct Number(#[serde(deserialize_with = "number")] f64);

#[derive(Deserialize)]
struct StoredFigure {
    name: String,
    title: String,
    caption: String,
    drawing: StoredDrawing,
}

#[derive(Deserialize)]
enum StoredDrawing {
    Graph(StoredGraph),
    Forces(StoredForces),
    Field(Field),
    Lines(LinePlot),
}

#[derive(Deserialize)]
struct StoredGraph {
    x: Axis,
    y: Axis,
    curves: Vec<StoredCurve>,
}

#[derive(Deserialize)]
struct StoredCurve {
    label: String,
    stroke: Stroke,
    points: Vec<(Number, Number)>,
}

#[derive(Deserialize)]
struct StoredForces {
    discs: Vec<([Number; 2], Number, Number)>,
    walls: Vec<([Number; 2], [Number; 2])>,
    bars: Vec<StoredBar>,
}

#[derive(Deserialize)]
struct StoredBar {
    from: [Number; 2],
    to: [Number; 2],
    force: Number,
    slipping: bool,
}

/// Reads a number; `null` is read as NaN.
pub(crate) fn number<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(from)?.unwrap_or(f64::NAN))
}

/// Reads figures in which numbers may be `null`.
pub(crate) fn figures<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Figure>, D::Error> {
    let stored = Vec::<StoredFigure>::deserialize(from)?;
    Ok(stored.into_iter().map(StoredFigure::read).collect())
}

fn point(point: [Number; 2]) -> [f64; 2] {
    point.map(|number| number.0)
}

impl StoredFigure {
    fn read(self) -> Figure {
        Figure {
            name: self.name,
            title: self.title,
            caption: self.caption,
            drawing: match self.drawing {
                StoredDrawing::Graph(graph) => Drawing::Graph(graph.read()),
                StoredDrawing::Forces(forces) => Drawing::Forces(forces.read()),
                StoredDrawing::Field(field) => Drawing::Field(field),
                StoredDrawing::Lines(lines) => Drawing::Lines(lines),
            },
        }
    }
}

impl StoredGraph {
    fn read(self) -> Graph {
        let curve = |curve: StoredCurve| Curve {
            label: curve.label,
            stroke: curve.stroke,
            points: curve.points.into_iter().map(|(x, y)| (x.0, y.0)).collect(),
        };
        Graph { x: self.x, y: self.y, curves: self.curves.into_iter().map(curve).collect() }
    }
}

impl StoredForces {
    fn read(self) -> ForcePlot {
        let discs = self.discs.into_iter();
        let walls = self.walls.into_iter();
        let bars = self.bars.into_iter();
        ForcePlot {
            discs: discs.map(|(centre, radius, angle)| (point(centre), radius.0, angle.0)).collect(),
            walls: walls.map(|(a, b)| (point(a), point(b))).collect(),
            bars: bars
                .map(|bar| ForceBar {
                    from: point(bar.from),
                    to: point(bar.to),
                    force: bar.force.0,
                    slipping: bar.slipping,
                })
                .collect(),
        }
    }
}
