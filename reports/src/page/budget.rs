//! Size limit of a page. Parts are moved to files beside the page until the remaining page is small enough. The least
//! important parts are moved first and, among equally important ones, the largest.

use maud::{PreEscaped, html};

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

/// Piece of the page.
pub(crate) enum Piece {
    /// HTML that always stays in the page.
    Fixed(String),
    /// Part that can be moved out of the page.
    Part(Part),
}

/// Part of the page that can be moved to a file.
pub(crate) struct Part {
    pub(crate) rank: Rank,
    /// HTML of the part in the page.
    pub(crate) whole: String,
    /// HTML that replaces a moved part: a link to its file or, for a figure, a lighter image.
    pub(crate) link: String,
    /// Path and text of the file; none if the file exists in any case.
    pub(crate) file: Option<(String, String)>,
}

impl Part {
    /// Returns a part with a table or a text. Its file is a separate page.
    pub(crate) fn text(rank: Rank, title: &str, path: String, whole: String) -> Self {
        let link = html! { p { a href=(path) { (title) } " (separate page)" } }.into_string();
        let body = html! { main.alone { h1 { (title) } (PreEscaped(&whole)) } };
        Self { rank, whole, link, file: Some((path, super::shell(title, &body))) }
    }
}

/// Returns the joined pieces with at most `limit` bytes if possible, and the paths and texts of the files beside the
/// page.
pub(crate) fn fit(mut pieces: Vec<Piece>, limit: usize) -> (String, Vec<(String, String)>) {
    let mut weight: usize = pieces
        .iter()
        .map(|piece| match piece {
            Piece::Fixed(text) => text.len(),
            Piece::Part(part) => part.whole.len(),
        })
        .sum();
    let mut order: Vec<(Rank, std::cmp::Reverse<usize>, usize)> = pieces
        .iter()
        .enumerate()
        .filter_map(|(at, piece)| match piece {
            Piece::Part(part) if part.whole.len() > part.link.len() => {
                Some((part.rank, std::cmp::Reverse(part.whole.len()), at))
            }
            _ => None,
        })
        .collect();
    order.sort_unstable();
    let gain = |piece: &Piece| match piece {
        Piece::Fixed(_) => 0,
        Piece::Part(part) => part.whole.len() - part.link.len(),
    };
    let mut away = Vec::new();
    for (_, _, at) in order {
        if weight <= limit {
            break;
        }
        weight -= gain(&pieces[at]);
        away.push(at);
    }
    // A large part may make room for smaller parts that were moved before it. The most important of these parts return
    // first.
    for at in std::mem::take(&mut away).into_iter().rev() {
        let with = weight + gain(&pieces[at]);
        if with <= limit {
            weight = with;
        } else {
            away.push(at);
        }
    }
    let mut beside = Vec::new();
    for at in away {
        if let Piece::Part(part) = &mut pieces[at] {
            beside.extend(part.file.take());
            part.whole = std::mem::take(&mut part.link);
        }
    }
    let text = pieces.into_iter().map(|piece| match piece {
        Piece::Fixed(text) | Piece::Part(Part { whole: text, .. }) => text,
    });
    (text.collect(), beside)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_missed_goes_first_and_only_as_much_as_must() {
        let part = |rank, letter: &str| {
            Piece::Part(Part {
                rank,
                whole: letter.repeat(100),
                link: letter.to_uppercase(),
                file: Some((letter.to_owned(), letter.repeat(100))),
            })
        };
        let pieces = || {
            vec![
                Piece::Fixed("-".repeat(100)),
                part(Rank::Rows, "r"),
                part(Rank::Costs, "f"),
                part(Rank::Controls, "c"),
            ]
        };
        let (text, beside) = fit(pieces(), 400);
        assert!(text.len() == 400 && beside.is_empty());
        let (text, beside) = fit(pieces(), 399);
        assert!(text.contains('F') && text.contains("rr") && text.contains("cc") && beside.len() == 1);
        let (text, beside) = fit(pieces(), 250);
        assert!(text.contains('F') && text.contains("rr") && text.contains('C') && beside.len() == 2);
        assert_eq!(fit(pieces(), 0).1.len(), 3);
    }

    /// The film of 90 bytes must be moved. The figure of 40 bytes, which was moved first, then returns.
    #[test]
    fn what_fits_again_comes_back() {
        let part = |rank, length: usize| {
            Piece::Part(Part { rank, whole: "x".repeat(length), link: "l".to_owned(), file: None })
        };
        let pieces = vec![part(Rank::Figures, 40), part(Rank::Films, 90), Piece::Fixed("-".repeat(10))];
        assert_eq!(fit(pieces, 60).0, format!("{}l{}", "x".repeat(40), "-".repeat(10)));
    }
}
