//! What a scene does not call for.

/// The stage of an effect that is absent: friction where μ = 0 for all laws, plastic strain where nothing yields, the
/// energy budget where no probe asks for it. It takes no memory and computes nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Off;
