//! Parameters common to all contacts of an evaluation.

use crate::contact::Evaluation;
use crate::contact::options::Options;
use crate::laws::Laws;

/// Parameters common to all contacts of an evaluation.
#[derive(Clone, Copy)]
pub(crate) struct Terms<'a> {
    /// Contact laws of the scene.
    pub(crate) laws: &'a Laws,
    /// Options of the convention.
    pub(crate) options: &'a Options,
    /// Time since the last evaluation (s).
    pub(crate) elapsed: f64,
}

impl<'a> Terms<'a> {
    pub(crate) fn evaluation(&self, record: bool) -> Evaluation<'a> {
        Evaluation { options: self.options, elapsed: self.elapsed, record }
    }
}
