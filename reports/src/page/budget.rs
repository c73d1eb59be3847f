//! Size limit of a page. Parts are moved to files beside the page until the remaining page is small enough. The least
//! important parts are moved first and, among equally important ones, the largest.

use maud::{Markup, Render, html};

/// Largest size of a page (bytes).
pub(crate) const PAGE: usize = 2_490_000;

/// Importance of a part. Parts of the first variants are moved out of the page first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Rank {
    Costs,
    Controls,
    /// Large figures. A moved figure is still shown, loaded from its file. A film keeps one frame.
    HeavyFigures,
    /// Figures in a closed section, which the reader must open.
    ClosedFigures,
    Derivations,
    Figures,
    Films,
    Rows,
}

/// Part of the page that can be moved to a file.
pub(crate) struct Part {
    pub(crate) rank: Rank,
    pub(crate) whole: Markup,
    /// Replacement of a moved part: a link to its file or, for a figure, a lighter image.
    pub(crate) link: Markup,
    /// Path and text of the file; none if the file exists in any case.
    pub(crate) file: Option<(String, String)>,
    pub(crate) is_moved: bool,
}

impl Part {
    /// Returns a figure. Its file exists in any case.
    pub(crate) const fn figure(rank: Rank, whole: Markup, link: Markup) -> Self {
        Self { rank, whole, link, file: None, is_moved: false }
    }

    /// Returns a part with a table or a text. Its file is a separate page.
    pub(crate) fn text(rank: Rank, title: &str, path: String, whole: Markup) -> Self {
        let link = html! { p { a href=(path) { (title) } " (separate page)" } };
        let body = html! { main.alone { h1 { (title) } (whole) } };
        let file = Some((path, super::shell(title, &body)));
        Self { rank, whole, link, file, is_moved: false }
    }

    fn gain(&self) -> usize {
        self.whole.0.len().saturating_sub(self.link.0.len())
    }
}

/// The part, or its replacement if it was moved out of the page.
impl Render for Part {
    fn render(&self) -> Markup {
        if self.is_moved { self.link.clone() } else { self.whole.clone() }
    }
}

/// Moves parts out of a page until it has at most `limit` bytes, if possible. `weight` is the size of the page without
/// its parts. Returns the paths and texts of the files beside the page.
pub(crate) fn fit(parts: &mut [&mut Part], weight: usize, limit: usize) -> Vec<(String, String)> {
    let mut weight = weight + parts.iter().map(|part| part.whole.0.len()).sum::<usize>();
    let mut order: Vec<usize> = (0..parts.len()).filter(|at| parts[*at].gain() > 0).collect();
    order.sort_by_key(|at| (parts[*at].rank, std::cmp::Reverse(parts[*at].whole.0.len()), *at));
    let mut away = Vec::new();
    for at in order {
        if weight <= limit {
            break;
        }
        weight -= parts[at].gain();
        away.push(at);
    }
    // A large part may make room for smaller parts that were moved before it. The most important of these parts return
    // first.
    for at in away.into_iter().rev() {
        let with = weight + parts[at].gain();
        if with <= limit {
            weight = with;
        } else {
            parts[at].is_moved = true;
        }
    }
    parts.iter_mut().filter(|part| part.is_moved).filter_map(|part| part.file.take()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use maud::PreEscaped;

    fn text(parts: &[Part]) -> String {
        html! { @for part in parts { (part) } }.into_string()
    }

    fn moved(parts: &mut [Part], limit: usize) -> usize {
        fit(&mut parts.iter_mut().collect::<Vec<_>>(), 100, limit).len()
    }

    #[test]
    fn the_least_missed_goes_first_and_only_as_much_as_must() {
        let part = |rank, letter: &str| Part {
            file: Some((letter.to_owned(), letter.repeat(100))),
            ..Part::figure(rank, PreEscaped(letter.repeat(100)), PreEscaped(letter.to_uppercase()))
        };
        let parts = || [part(Rank::Rows, "r"), part(Rank::Costs, "f"), part(Rank::Controls, "c")];
        let fitted = |limit| {
            let mut parts = parts();
            let count = moved(&mut parts, limit);
            (text(&parts), count)
        };
        let (page, beside) = fitted(400);
        assert!(page.len() == 300 && beside == 0);
        let (page, beside) = fitted(399);
        assert!(page.contains('F') && page.contains("rr") && page.contains("cc") && beside == 1);
        let (page, beside) = fitted(250);
        assert!(page.contains('F') && page.contains("rr") && page.contains('C') && beside == 2);
        assert_eq!(fitted(0).1, 3);
    }

    /// The film of 90 bytes must be moved. The figure of 40 bytes, which was moved first, then returns.
    #[test]
    fn what_fits_again_comes_back() {
        let part = |rank, length: usize| Part::figure(rank, PreEscaped("x".repeat(length)), PreEscaped("l".to_owned()));
        let mut parts = [part(Rank::Figures, 40), part(Rank::Films, 90)];
        moved(&mut parts, 150);
        assert_eq!(text(&parts), format!("{}l", "x".repeat(40)));
    }
}
