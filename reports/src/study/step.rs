//! Cost model of a step: cost of its parts, and comparison with the peak performance of the machine.

use crate::number;
use crate::row;
use crate::table::{Column, Table};
use grainbench_harness::statistics::{median, range};
use maud::{Markup, html};
use serde::{Deserialize, Serialize};

/// Cost of a part of a step with one solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TaskCost {
    /// Name of the solver, such as `dem`.
    pub solver: String,
    /// Part of a step to which the cost applies: a grain, a listed pair, a contact, a material point or a node.
    pub piece: String,
    /// Method of the measurement, in words.
    pub found: String,
    /// Processor time per part and step, for each timing (ns).
    pub nanoseconds: Vec<f64>,
}

/// Peak performance of the machine with one thread.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Probe {
    /// Memory traffic outside the caches, reading and writing, for each timing (bytes/ns).
    pub streamed: Vec<f64>,
    /// Multiplications and additions in registers, for each timing (1/ns).
    pub computed: Vec<f64>,
}

/// Costs of the parts of a step, and peak performance of the machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Model {
    /// Costs of the parts of a step.
    pub prices: Vec<TaskCost>,
    /// Peak performance of the machine.
    pub probe: Probe,
}

/// Renders the costs of the parts of a step as a table with an explanation.
pub(crate) fn render(model: &Model) -> Markup {
    let [streamed, computed] = [&model.probe.streamed, &model.probe.computed].map(|laps| median(laps));
    let columns =
        ["Time in a step (ns)", "least to largest", "Bytes transferred in that time", "Additions in that time"];
    let columns = [Column::heading("Part of a step")].into_iter().chain(columns.map(Column::text));
    let row = |price: &TaskCost| {
        let time = median(&price.nanoseconds);
        let part = html! { (price.solver) ", " (price.piece) span.title { (price.found) } };
        let shown = |value| number::significant(value, 3);
        let spread =
            range(&price.nanoseconds).map(|[least, _, largest]| format!("{} to {}", shown(least), shown(largest)));
        row![part, shown(time), spread.unwrap_or_default(), shown(time * streamed), shown(time * computed)]
    };
    let table = Table::new("Cost of a step", columns, model.prices.iter().map(row));
    html! {
        h3 { "Cost of a step by part" }
        p {
            "Processor time of one thread for one part of a step, from a long run minus a short run. The time of a \
             step is the sum over its grains, listed pairs and contacts. The time to rebuild the list of pairs is \
             excluded. The scenes have ten thousand discs, sixteen thousand spheres and up to 58 thousand points, \
             which fit partly into caches; in larger scenes the same parts cost more. The last columns show what this \
             machine can transfer and compute in the same time: " (number::significant(streamed, 3)) " B/ns read from and \
             written to memory outside the caches, and " (number::significant(computed, 3)) " multiplications and \
             additions per nanosecond in registers."
        }
        (table.page("cases"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The machine moves 30 bytes/ns and computes 50 operations/ns. In 8 ns it moves 240 bytes and computes 400
    /// operations.
    #[test]
    fn a_price_stands_beside_what_the_machine_does() {
        let price = TaskCost {
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
