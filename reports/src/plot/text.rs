//! Symbols with subscripts in texts. A symbol is a single letter, followed by an underscore and the subscript, such as
//! `v_t`.

use maud::{Markup, html};

/// A part of a text.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Part<'a> {
    Plain(&'a str),
    Sub(&'a str),
}

/// Splits a text into plain parts and subscripts. Names such as `nine_discs` have no subscript.
fn parts(text: &str) -> Vec<Part<'_>> {
    let (mut parts, mut from) = (Vec::new(), 0);
    for (at, _) in text.match_indices('_') {
        let mut before = text[..at].chars().rev();
        let is_letter = before.next().is_some_and(char::is_alphabetic);
        let is_alone = before.next().is_none_or(|letter| !(letter.is_alphanumeric() || letter == '_'));
        let rest = &text[at + 1..];
        let is_end = |letter: char| !(letter.is_alphabetic() || letter.is_ascii_digit());
        let length = rest.find(is_end).unwrap_or(rest.len());
        if at >= from && is_letter && is_alone && length > 0 {
            parts.extend([Part::Plain(&text[from..at]), Part::Sub(&rest[..length])]);
            from = at + 1 + length;
        }
    }
    if from < text.len() || parts.is_empty() {
        parts.push(Part::Plain(&text[from..]));
    }
    parts
}

/// Returns a text as the content of an SVG `text` element.
pub(crate) fn svg(text: &str) -> Markup {
    let parts = parts(text);
    html! {
        @for (at, part) in parts.iter().enumerate() {
            @match part {
                Part::Plain(text) if at == 0 => { (text) }
                // Returns to the baseline: the shift was 0.3 of a font that is 0.75 as large.
                Part::Plain(text) => { tspan dy="-.225em" { (text) } }
                Part::Sub(text) => { tspan dy=".3em" font-size=".75em" { (text) } }
            }
        }
    }
}

/// Returns a text as HTML.
pub(crate) fn html(text: &str) -> Markup {
    html! {
        @for part in parts(text) {
            @match part {
                Part::Plain(text) => { (text) }
                Part::Sub(text) => { sub { (text) } }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_single_letters_have_subscripts() {
        use Part::{Plain, Sub};
        assert_eq!(parts("|x − x_rigid| (m)"), [Plain("|x − x"), Sub("rigid"), Plain("| (m)")]);
        assert_eq!(parts("σ_xy/σ_yy"), [Plain("σ"), Sub("xy"), Plain("/σ"), Sub("yy")]);
        for name in ["nine_discs", "60deg-mu2_7", "a_", "_b", "", "kappa-2_3"] {
            assert_eq!(parts(name), [Plain(name)]);
        }
    }

    #[test]
    fn a_text_returns_to_its_line() {
        let text = svg("v_n < 1").into_string();
        let expected = "v<tspan dy=\".3em\" font-size=\".75em\">n</tspan><tspan dy=\"-.225em\"> &lt; 1</tspan>";
        assert_eq!(text, expected);
        assert_eq!(html("v_n < 1").into_string(), "v<sub>n</sub> &lt; 1");
    }
}
