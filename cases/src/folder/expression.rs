//! Arithmetic over named numbers, for claims in files.
//!
//! Operators are `+ - * /` and `^`. `^` binds more tightly than a sign before it and associates to the right: −2^2 =
//! −4, 2^3^2 = 512. There are parentheses, `pi` and named functions. A name is a path of keys such as
//! `grains.ball.radius`; a name with other characters is in braces, `{contacts.ball-plane.friction}`. Angles are in
//! radians. No crate is used, because the crates that we tried read −2^2 as 4 or cannot read `1e-3`.

use std::f64::consts::PI;
use std::fmt;

/// Largest depth of nested parentheses, signs and powers.
const DEEPEST: usize = 100;
/// Largest count of numbers and names in an expression. It also limits the recursion depth, because a chain of
/// operators gives a tree as deep as the chain is long.
const MOST_TERMS: usize = 1000;

/// Arithmetic expression of a claim or sweep file.
#[derive(Clone, Debug)]
pub enum Expression {
    /// Literal number.
    Number(f64),
    /// Named number.
    Name(String),
    /// Operator or function with its arguments.
    Call(Function, Vec<Self>),
}

/// Operator, such as `+`, or function, such as `sin`, with the number of its arguments.
#[derive(Clone, Copy)]
pub struct Function {
    name: &'static str,
    arguments: usize,
    of: fn(&[f64]) -> f64,
}

/// Prints only the name, because the address of the function differs from process to process.
impl fmt::Debug for Function {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name)
    }
}

const fn one(name: &'static str, function: fn(&[f64]) -> f64) -> Function {
    Function { name, arguments: 1, of: function }
}

const fn two(name: &'static str, function: fn(&[f64]) -> f64) -> Function {
    Function { name, arguments: 2, of: function }
}

const SUMS: [Function; 2] = [two("+", |x| x[0] + x[1]), two("-", |x| x[0] - x[1])];
const PRODUCTS: [Function; 2] = [two("*", |x| x[0] * x[1]), two("/", |x| x[0] / x[1])];
const POWER: Function = two("^", |x| x[0].powf(x[1]));
const NEGATIVE: Function = one("-", |x| -x[0]);

const FUNCTIONS: [Function; 17] = [
    one("sin", |x| x[0].sin()),
    one("cos", |x| x[0].cos()),
    one("tan", |x| x[0].tan()),
    one("asin", |x| x[0].asin()),
    one("acos", |x| x[0].acos()),
    one("atan", |x| x[0].atan()),
    two("atan2", |x| x[0].atan2(x[1])),
    one("sinh", |x| x[0].sinh()),
    one("cosh", |x| x[0].cosh()),
    one("tanh", |x| x[0].tanh()),
    one("exp", |x| x[0].exp()),
    one("ln", |x| x[0].ln()),
    one("sqrt", |x| x[0].sqrt()),
    one("cbrt", |x| x[0].cbrt()),
    one("abs", |x| x[0].abs()),
    // NaN if either argument is NaN.
    two("min", |x| if x[0].is_nan() || x[0] < x[1] { x[0] } else { x[1] }),
    two("max", |x| if x[0].is_nan() || x[0] > x[1] { x[0] } else { x[1] }),
];

impl Expression {
    /// Parses an expression.
    ///
    /// # Errors
    /// The message gives the expected text, the found text and the column.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut reader = Reader { text, at: 0, depth: 0, terms: 0 };
        let expression = reader.sum()?;
        match reader.next() {
            None => Ok(expression),
            Some(_) => Err(reader.expected("an operator or the end")),
        }
    }

    /// Returns the names in the expression.
    pub fn names(&self) -> Vec<&str> {
        match self {
            Self::Number(_) => Vec::new(),
            Self::Name(name) => vec![name],
            Self::Call(_, arguments) => arguments.iter().flat_map(Self::names).collect(),
        }
    }

    /// Evaluates the expression with the values of its names. An unknown name gives NaN.
    pub fn value(&self, variable: &dyn Fn(&str) -> Option<f64>) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::Name(name) => variable(name).unwrap_or(f64::NAN),
            Self::Call(function, arguments) => {
                (function.of)(&arguments.iter().map(|argument| argument.value(variable)).collect::<Vec<_>>())
            }
        }
    }
}

/// Recursive-descent parser.
struct Reader<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    terms: usize,
}

impl Reader<'_> {
    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    /// Returns the next non-blank character without consuming it.
    fn next(&mut self) -> Option<char> {
        self.at += self.rest().len() - self.rest().trim_start().len();
        self.rest().chars().next()
    }

    /// Consumes `symbol` and blanks before it, and returns true if it comes next.
    fn takes(&mut self, symbol: &str) -> bool {
        let is_there = self.next().is_some() && self.rest().starts_with(symbol);
        if is_there {
            self.at += symbol.len();
        }
        is_there
    }

    fn expected(&mut self, what: &str) -> String {
        let found = self.next().map_or_else(|| "the end".to_owned(), |letter| format!("`{}`", letter.escape_default()));
        format!("expected {what} at column {}, found {found}", self.text[..self.at].chars().count() + 1)
    }

    /// Parses a sum of products.
    fn sum(&mut self) -> Result<Expression, String> {
        self.operators(&SUMS, |reader| reader.operators(&PRODUCTS, Self::signed))
    }

    /// Parses operators of one precedence, which associate to the left.
    fn operators(
        &mut self,
        rank: &[Function],
        side: impl Fn(&mut Self) -> Result<Expression, String>,
    ) -> Result<Expression, String> {
        let mut left = side(self)?;
        while let Some(operator) = rank.iter().find(|operator| self.takes(operator.name)) {
            left = Expression::Call(*operator, vec![left, side(self)?]);
        }
        Ok(left)
    }

    /// Parses a power with optional minus signs before it.
    fn signed(&mut self) -> Result<Expression, String> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(format!("expected at most {DEEPEST} levels, found more"));
        }
        let signed = if self.takes(NEGATIVE.name) {
            Expression::Call(NEGATIVE, vec![self.signed()?])
        } else {
            let base = self.atom()?;
            if self.takes(POWER.name) { Expression::Call(POWER, vec![base, self.signed()?]) } else { base }
        };
        self.depth -= 1;
        Ok(signed)
    }

    fn atom(&mut self) -> Result<Expression, String> {
        self.terms += 1;
        if self.terms > MOST_TERMS {
            let column = self.text[..self.at].chars().count() + 1;
            return Err(format!("expected at most {MOST_TERMS} numbers and names, found more at column {column}"));
        }
        match self.next() {
            Some('(') => {
                self.takes("(");
                let inner = self.sum()?;
                if self.takes(")") { Ok(inner) } else { Err(self.expected("`)`")) }
            }
            Some('{') => self.braced(),
            Some(letter) if letter.is_ascii_digit() || letter == '.' => self.number(),
            Some(letter) if letter.is_alphabetic() => self.named(),
            _ => Err(self.expected("a number, a name or `(`")),
        }
    }

    fn braced(&mut self) -> Result<Expression, String> {
        let inner = self.rest().get(1..).and_then(|rest| rest.split_once('}')).map(|(inner, _)| inner.to_owned());
        let Some(inner) = inner else { return Err(self.expected("a name in braces, with `}` after it")) };
        self.at += inner.len() + 2;
        Ok(Expression::Name(inner.trim().to_owned()))
    }

    fn number(&mut self) -> Result<Expression, String> {
        let digits = |text: &str| text.len() - text.trim_start_matches(|letter: char| letter.is_ascii_digit()).len();
        let rest = self.rest();
        let mut end = digits(rest);
        if rest[end..].starts_with('.') {
            end += 1 + digits(&rest[end + 1..]);
        }
        if rest[end..].starts_with(['e', 'E']) {
            let sign = usize::from(rest[end + 1..].starts_with(['+', '-']));
            let power = digits(&rest[end + 1 + sign..]);
            end += if power > 0 { 1 + sign + power } else { 0 };
        }
        match rest[..end].parse() {
            Ok(value) if f64::is_finite(value) => {
                self.at += end;
                Ok(Expression::Number(value))
            }
            _ => Err(self.expected("a finite number")),
        }
    }

    fn named(&mut self) -> Result<Expression, String> {
        let is_part = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == '.';
        let rest = self.rest();
        let name = rest[..rest.find(|letter| !is_part(letter)).unwrap_or(rest.len())].to_owned();
        let before = self.at;
        self.at += name.len();
        if self.next() != Some('(') {
            return Ok(if name == "pi" { Expression::Number(PI) } else { Expression::Name(name) });
        }
        let Some(function) = FUNCTIONS.iter().find(|function| function.name == name) else {
            self.at = before;
            let names: Vec<&str> = FUNCTIONS.iter().map(|function| function.name).collect();
            return Err(self.expected(&format!("a function, one of {},", names.join(", "))));
        };
        self.takes("(");
        let mut arguments = vec![self.sum()?];
        while self.takes(",") {
            arguments.push(self.sum()?);
        }
        if !self.takes(")") {
            return Err(self.expected("`,` or `)`"));
        }
        if arguments.len() != function.arguments {
            return Err(format!("expected {} of `{name}`, found {}", function.arguments, arguments.len()));
        }
        Ok(Expression::Call(*function, arguments))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Result<f64, String> {
        Expression::read(text).map(|read| read.value(&|name| if name == "a.b" { Some(3.0) } else { None }))
    }

    #[test]
    fn operators_bind_as_they_are_written_on_paper() {
        let known = [
            ("-2^2", -4.0),
            ("2^3^2", 512.0),
            ("2^-1", 0.5),
            ("1 - 2 - 3", -4.0),
            ("8/2/2", 2.0),
            ("2*-3", -6.0),
            ("-a.b^2 + {a.b}", -6.0),
            ("1e-3 + 1.5E3 + .5", 1500.501),
            ("max(1, 2) * sqrt(4) - abs(-1)", 3.0),
            ("atan2(1, 1) * 4 - pi", 0.0),
            ("5/7 * (1 + 1)", 10.0 / 7.0),
        ];
        for (text, expected) in known {
            assert!(value(text).is_ok_and(|found| (found - expected).abs() < 1e-14), "{text}: {:?}", value(text));
        }
        let long = "1+".repeat(999) + "1";
        assert_eq!(value(&long), Ok(1000.0));
        assert!(value("max(nothing, 1)").is_ok_and(f64::is_nan), "what has no value is no number");
    }

    #[test]
    fn errors_name_the_column() {
        let (deep, long) = ("(".repeat(1000), "1+".repeat(20_000) + "1");
        for (text, message) in [
            ("", "expected a number, a name or `(` at column 1, found the end"),
            ("1 +", "at column 4, found the end"),
            ("(1", "expected `)` at column 3"),
            ("1 2", "expected an operator or the end at column 3, found `2`"),
            ("{a", "expected a name in braces"),
            ("sine(1)", "expected a function, one of sin, cos"),
            ("min(1)", "expected 2 of `min`, found 1"),
            ("1e999", "expected a finite number"),
            ("1 $", "found `$`"),
            ("µ", "`µ`"),
            (deep.as_str(), "expected at most 100 levels"),
            (long.as_str(), "expected at most 1000 numbers and names, found more at column 2001"),
        ] {
            let found = value(text);
            let is_said = found.as_ref().is_err_and(|error| error.contains(message));
            assert!(is_said || (text == "µ" && found.is_ok_and(f64::is_nan)), "{text}: {:?}", value(text));
        }
    }
}
