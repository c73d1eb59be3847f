//! Text of a study for the terminal.

use super::estimate::{Estimate, SceneCost, difference_words, softer_words};
use super::point::Diagram;
use super::{Study, cost, effects, stability_page};
use crate::number;
use crate::table::{Column, Columns, Format, Table};

impl Study {
    /// Returns the study as text: sentences about costs and their changes, and tables of estimates, largest stable steps, hard
    /// cases and effects.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text: String = self.diagrams.iter().map(diagram).collect();
        if let Some(old) = &self.against {
            let none = if self.changes.is_empty() { cost::NO_CHANGE } else { "" };
            text += &format!("against {old}: {none}\n");
        }
        text.extend(self.changes.iter().map(|change| format!("  {}: {}\n", change.what, change.how)));
        text.extend(self.scenes.iter().map(|cost| self.estimates(cost)));
        let tables = [
            (!self.limits.is_empty()).then(|| stability_page::limits_table(&self.limits)),
            (!self.hard.is_empty()).then(|| stability_page::hard_table(&self.hard)),
            (!self.ledger.is_empty()).then(|| effects::results_table(&self.ledger)),
        ];
        let tables: Vec<String> = tables.into_iter().flatten().map(Table::text).collect();
        if !text.is_empty() && !tables.is_empty() {
            text.push('\n');
        }
        text += &tables.join("\n");
        for cost in &self.scenes {
            text.push('\n');
            text.extend(cost.notes.iter().map(|note| format!("note: {note}\n")));
            text += &format!("{} of a budget of {}\n", number::seconds(cost.spent), number::seconds(cost.budget));
        }
        text
    }

    /// Returns the estimates of a scene: sentences about costs, and one table for each quantity.
    fn estimates(&self, cost: &SceneCost) -> String {
        let mut text =
            format!("{}, {}; errors are estimates from the levels of each solver\n", cost.scene, cost.reduction.word());
        text.extend(cost::TARGETS.map(|target| format!("  {}\n", cost.sentence(target, &self.limits))));
        for quantity in &cost.quantities {
            let digits = |name: &str, digits| Column::new(name, Format::Digits(digits)).unit(&quantity.unit);
            let columns = Columns::<&Estimate>::new(Column::text("Solver"), |row| &row.solver)
                .and(digits(&quantity.name, 6), |row| row.value)
                .and(digits("Uncertainty", 2), |row| row.uncertainty)
                .and(Column::new("Order", Format::Digits(2)), |row| row.order)
                .and(Column::text("Basis"), |row| row.basis.word());
            text += &format!("\n{}", columns.table("", &quantity.estimates, |_| "").text());
            text.extend(quantity.differences().iter().map(|difference| difference_words(difference) + "\n"));
            text += &format!("{}\n", cost.sentence_of(quantity, cost::TARGETS[1], &self.limits));
        }
        text.extend(softer_words(cost).into_iter().map(|sentence| format!("softer contacts: {sentence}\n")));
        text
    }
}

/// Returns the quantity of a diagram, with a sentence about the cost of each error.
fn diagram(diagram: &Diagram) -> String {
    let sentences = cost::TARGETS.map(|target| format!("  {}\n", cost::sentence(diagram, target)));
    format!("{}/{} · {}\n{}", diagram.case, diagram.variant, diagram.quantity, sentences.concat())
}
