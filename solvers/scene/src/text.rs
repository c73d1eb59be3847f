//! Other people's text where it is shown: titles, keys, names of files.

/// The text with every character written out that would steer a terminal, hide, or turn the direction of writing; those
/// that `keeps` names stay.
#[must_use]
pub fn tamed(text: &str, keeps: impl Fn(char) -> bool) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        let disguises = matches!(
            character,
            '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}'
        );
        if (character.is_control() || disguises) && !keeps(character) {
            safe.extend(character.escape_unicode());
        } else {
            safe.push(character);
        }
    }
    safe
}
