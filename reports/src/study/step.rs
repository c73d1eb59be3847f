//! What a step costs, piece of work by piece of work: the rows, and their table beside what the machine does at most in the same
//! time.

use crate::number;
use crate::page::scrolling;
use grainbench_harness::statistics::{median, range};
use maud::{Markup, html};
use serde::{Deserialize, Serialize};

/// What a solver takes for a piece of work.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Price {
    /// The solver.
    pub solver: String,
    /// The piece: a grain in space, a listed pair, a contact, a material point, a node.
    pub piece: String,
    /// How it was found.
    pub found: String,
    /// Processor time for one in one step, lap by lap (ns).
    pub nanoseconds: Vec<f64>,
}

/// What the machine does at most on one thread.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Probe {
    /// Bytes read and written in a nanosecond, out of the caches' reach, lap by lap.
    pub streamed: Vec<f64>,
    /// Numbers multiplied or added in registers in a nanosecond, lap by lap.
    pub computed: Vec<f64>,
}

/// Prices, beside what the machine can do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Model {
    /// Piece by piece.
    pub prices: Vec<Price>,
    /// The machine.
    pub probe: Probe,
}

/// The table with its words.
pub(crate) fn render(model: &Model) -> Markup {
    let [streamed, computed] = [&model.probe.streamed, &model.probe.computed].map(|laps| median(laps));
    let table = html! {
        table.cases {
            thead {
                tr {
                    th scope="col" { "Piece of work" }
                    th scope="col" { "Time in a step (ns)" }
                    th scope="col" { "least to largest" }
                    th scope="col" { "Streamed in that time (B)" }
                    th scope="col" { "Computed in that time" }
                }
            }
            tbody {
                @for price in &model.prices {
                    @let time = median(&price.nanoseconds);
                    tr {
                        th scope="row" { (price.solver) ", " (price.piece) span.title { (price.found) } }
                        td { (number::significant(time, 3)) }
                        td { (spread(price)) }
                        td { (number::significant(time * streamed, 3)) }
                        td { (number::significant(time * computed, 3)) }
                    }
                }
            }
        }
    };
    html! {
        h3 { "What a step costs, piece by piece" }
        p {
            "Processor time of one thread, of long runs less short ones, for one piece of work in one step: a step of "
            "grains takes as long as its grains, listed pairs and contacts together, and now and then its list, which is not "
            "counted here. The scenes are of ten thousand discs, sixteen thousand spheres and up to 58 thousand points, which "
            "caches hold in part: in larger ones the same pieces cost more. Beside each price stands what this machine does "
            "at most in that time: " (number::significant(streamed, 3)) " B/ns read from and written to memory that no "
            "cache holds, and " (number::significant(computed, 3)) " multiplications and additions a nanosecond in "
            "registers."
        }
        (scrolling("What a step costs", &table))
    }
}

/// The least and the largest of the laps.
fn spread(price: &Price) -> String {
    let shown = |value| number::significant(value, 3);
    range(&price.nanoseconds)
        .map_or_else(String::new, |[least, _, largest]| format!("{} to {}", shown(least), shown(largest)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In 8 ns a machine that streams 30 B and computes 50 numbers in one does 240 B and 400 numbers.
    #[test]
    fn a_price_stands_beside_what_the_machine_does() {
        let price = Price {
            solver: "dem".to_owned(),
            piece: "contact".to_owned(),
            found: "discs".to_owned(),
            nanoseconds: vec![9.0, 7.5, 8.0],
        };
        let probe = Probe { streamed: vec![30.0], computed: vec![50.0] };
        let page = render(&Model { prices: vec![price], probe }).into_string();
        for cell in ["<td>8</td>", "<td>7.5 to 9</td>", "<td>240</td>", "<td>400</td>"] {
            assert!(page.contains(cell), "{cell} is not in {page}");
        }
    }
}
