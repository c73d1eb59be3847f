//! Marker type of absent effects.

/// Type of an absent effect. It replaces friction if μ = 0 for all laws, plastic strain if nothing yields, and the
/// energy budget if no probe requests it. It takes no memory and computes nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AbsentEffect;
