//! Text on a terminal: width, line breaks and colours. Text in files and pipes has neither breaks nor, without
//! `--color always`, colours.

use grainbench::scene::text::tamed;
use std::ffi::OsString;
use std::io::{self, IsTerminal};
use std::sync::OnceLock;

/// Use of colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Color {
    /// Colours on a terminal, unless the environment has `NO_COLOR` or `TERM=dumb`.
    Auto,
    Always,
    Never,
}

/// Choice of `--color`; [`Color::Auto`] until [`choose`] is called.
static CHOICE: OnceLock<Color> = OnceLock::new();

/// Marks at the start of a line, and kinds of messages, with the codes of their colours.
const COLORS: [(&str, &str); 6] =
    [("✓", "32"), ("✗", "31"), ("▲", "33"), ("error:", "31"), ("warning:", "33"), ("note:", "36")];

/// Sets the use of colours.
pub(crate) fn choose(color: Color) {
    let _ = CHOICE.set(color);
}

/// Returns the choice in a command line, for the help and the errors of the parser. An invalid choice is reported later.
pub(crate) fn choice_in(arguments: &[OsString]) -> clap::ColorChoice {
    let words: Vec<&str> = arguments.iter().map_while(|word| word.to_str().filter(|word| *word != "--")).collect();
    let value = |pair: &[&str]| match pair {
        ["--color", value] => Some((*value).to_owned()),
        [word, ..] => word.strip_prefix("--color=").map(str::to_owned),
        [] => None,
    };
    let pairs = (0..words.len()).map(|at| &words[at..words.len().min(at + 2)]);
    match pairs.filter_map(value).next_back().as_deref() {
        Some("always") => clap::ColorChoice::Always,
        Some("never") => clap::ColorChoice::Never,
        _ => clap::ColorChoice::Auto,
    }
}

/// Returns true if text on this stream has colours.
fn is_colored(is_terminal: bool) -> bool {
    let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    match CHOICE.get().copied().unwrap_or(Color::Auto) {
        Color::Always => true,
        Color::Never => false,
        Color::Auto => is_terminal && !is_set("NO_COLOR") && std::env::var_os("TERM").is_none_or(|term| term != "dumb"),
    }
}

/// Returns the width of the terminal (characters); unlimited if the standard output is a file or pipe.
pub(crate) fn width() -> usize {
    let size = console::Term::stdout().size_checked();
    size.filter(|_| io::stdout().is_terminal()).map_or(usize::MAX, |(_, columns)| usize::from(columns).max(20))
}

/// Returns text for a reader at the terminal: long lines are broken at spaces, and marks have their colours. None if the
/// text needs neither.
pub(crate) fn shown(text: &str) -> Option<String> {
    let (width, is_colored) = (width(), is_colored(io::stdout().is_terminal()));
    if width == usize::MAX && !is_colored {
        return None;
    }
    let text = tamed(text, |character| matches!(character, '\n' | '\t'));
    let mut shown = String::new();
    for line in text.split_inclusive('\n') {
        let (line, end) = line.strip_suffix('\n').map_or((line, ""), |line| (line, "\n"));
        let line = broken(line, width);
        shown += &if is_colored { painted(&line) } else { line };
        shown += end;
    }
    Some(shown)
}

/// Returns a message for the standard error, with the colour of its kind.
pub(crate) fn message(line: String) -> String {
    if is_colored(io::stderr().is_terminal()) { painted(&line) } else { line }
}

/// Returns a line with the colour of its first mark or word.
fn painted(line: &str) -> String {
    let found = COLORS.iter().find_map(|(mark, code)| Some((mark, code, line.strip_prefix(mark)?)));
    found.map_or_else(|| line.to_owned(), |(mark, code, rest)| format!("\u{1b}[{code}m{mark}\u{1b}[0m{rest}"))
}

/// Breaks a line at spaces, so that each part has at most `width` characters. Further parts are indented. A longer word
/// has a part of its own.
fn broken(line: &str, width: usize) -> String {
    const INDENT: &str = "    ";
    if line.chars().count() <= width {
        return line.to_owned();
    }
    let (mut text, mut length) = (String::new(), 0);
    for word in line.split_inclusive(' ') {
        let needed = word.trim_end().chars().count();
        if length > INDENT.len() && length + needed > width {
            text.truncate(text.trim_end().len());
            text += &format!("\n{INDENT}");
            length = INDENT.len();
        }
        text += word;
        length += word.chars().count();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_broken_at_spaces() {
        assert_eq!(broken("a short line", 12), "a short line");
        assert_eq!(broken("one two three four", 12), "one two\n    three\n    four");
        assert_eq!(broken("unbreakable-word and more", 10), "unbreakable-word\n    and\n    more");
        let long = "word ".repeat(40);
        assert!(broken(&long, 30).lines().all(|line| line.chars().count() <= 30));
    }

    #[test]
    fn marks_have_colours() {
        assert_eq!(painted("✗ a · b"), "\u{1b}[31m✗\u{1b}[0m a · b");
        assert_eq!(painted("a ✗ b"), "a ✗ b");
    }

    #[test]
    fn the_choice_is_read_before_the_parser_runs() {
        let choice = |words: &[&str]| choice_in(&words.iter().map(OsString::from).collect::<Vec<_>>());
        assert_eq!(choice(&["grainbench", "list", "--color", "never"]), clap::ColorChoice::Never);
        assert_eq!(choice(&["grainbench", "--color=always", "list"]), clap::ColorChoice::Always);
        assert_eq!(choice(&["grainbench", "list", "--", "--color=always"]), clap::ColorChoice::Auto);
    }
}
