//! Four numbers at a time. Loops over points are written once, for a number; points that reach the same nodes are taken
//! four by four, with vector instructions where the processor has them.
//!
//! Every operation is that of each lane by itself, rounded once, and sums over lanes have one order: the same bits on
//! all processors. So nothing is fused, and no loop is left to the compiler to reorder.
//!
//! Whatever computes with lanes is inlined into the loop that is compiled for the processor. Closures may not be, and
//! then every operation is a call: there are none, but those that only look something up.

#[cfg(target_arch = "x86_64")]
mod avx;
mod portable;

use std::ops::{Add, Div, Mul, Neg, Sub};

pub(crate) use portable::Portable;

/// Lanes of a register.
pub(crate) const LANES: usize = 4;

/// What computes with four lanes.
pub(crate) trait Lanes: Copy + 'static {
    /// Four numbers.
    type Register: Copy;
    /// The same number in every lane.
    fn splat(self, value: f64) -> Self::Register;
    /// A number for each lane.
    fn of(self, values: [f64; LANES]) -> Self::Register;
    /// The number in each lane.
    fn values(self, of: Self::Register) -> [f64; LANES];
    /// `a + b`.
    fn add(self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// `a − b`.
    fn sub(self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// `a b`.
    fn mul(self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// `a / b`.
    fn div(self, a: Self::Register, b: Self::Register) -> Self::Register;
    /// `yes` where `a < b`, else `no`.
    fn pick(self, a: Self::Register, b: Self::Register, yes: Self::Register, no: Self::Register) -> Self::Register;
    /// The sums over the lanes of four registers, (a₀ + a₁) + (a₂ + a₃).
    fn sums(self, of: [Self::Register; LANES]) -> [f64; LANES];
}

/// A number, or four.
pub(crate) trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// A constant, to compute with this one.
    fn like(self, value: f64) -> Self;
    /// `yes` where this is less than `bound`, else `no`.
    fn pick_below(self, bound: Self, yes: Self, no: Self) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn like(self, value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn pick_below(self, bound: Self, yes: Self, no: Self) -> Self {
        if self < bound { yes } else { no }
    }
}

/// Four numbers with what computes with them.
#[derive(Clone, Copy)]
pub(crate) struct Four<L: Lanes> {
    lanes: L,
    register: L::Register,
}

impl<L: Lanes> Four<L> {
    /// A number for each lane.
    #[inline(always)]
    pub(crate) fn new(lanes: L, values: [f64; LANES]) -> Self {
        Self { lanes, register: lanes.of(values) }
    }

    /// The same number in every lane.
    #[inline(always)]
    pub(crate) fn splat(lanes: L, value: f64) -> Self {
        Self { lanes, register: lanes.splat(value) }
    }

    /// Three numbers, each times another.
    #[inline(always)]
    pub(crate) fn scaled([a, b, c]: [Self; 3], by: Self) -> [Self; 3] {
        [a * by, b * by, c * by]
    }

    /// The number in each lane.
    #[inline(always)]
    pub(crate) fn values(self) -> [f64; LANES] {
        self.lanes.values(self.register)
    }

    /// The sums over the lanes of each.
    #[inline(always)]
    pub(crate) fn sums(of: [Self; LANES]) -> [f64; LANES] {
        let [a, b, c, d] = of;
        a.lanes.sums([a.register, b.register, c.register, d.register])
    }
}

impl<L: Lanes> Number for Four<L> {
    #[inline(always)]
    fn like(self, value: f64) -> Self {
        Self::splat(self.lanes, value)
    }
    #[inline(always)]
    fn pick_below(self, bound: Self, yes: Self, no: Self) -> Self {
        Self { register: self.lanes.pick(self.register, bound.register, yes.register, no.register), ..self }
    }
}

/// An operator on four numbers, and on four numbers and a constant.
macro_rules! operator {
    ($Operator:ident, $operator:ident) => {
        impl<L: Lanes> $Operator for Four<L> {
            type Output = Self;
            #[inline(always)]
            fn $operator(self, other: Self) -> Self {
                Self { register: self.lanes.$operator(self.register, other.register), ..self }
            }
        }
        impl<L: Lanes> $Operator<f64> for Four<L> {
            type Output = Self;
            #[inline(always)]
            fn $operator(self, other: f64) -> Self {
                self.$operator(self.like(other))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl<L: Lanes> Neg for Four<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // Not 0 − x, which has another zero.
        self * -1.0
    }
}

/// A loop that takes points four by four.
pub(crate) trait Kernel {
    /// Runs it.
    fn run<L: Lanes>(self, lanes: L);
}

/// The best that this processor has.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Processor {
    /// What every processor can do.
    Portable,
    /// Registers of 256 bits (x86-64-v3).
    #[cfg(target_arch = "x86_64")]
    Avx(pulp::x86::V3),
}

impl Processor {
    pub(crate) fn new() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(features) = pulp::x86::V3::try_new() {
            return Self::Avx(features);
        }
        Self::Portable
    }

    /// Runs a loop.
    #[inline(always)]
    pub(crate) fn run(self, kernel: impl Kernel) {
        match self {
            Self::Portable => kernel.run(Portable),
            #[cfg(target_arch = "x86_64")]
            Self::Avx(features) => avx::run(features, kernel),
        }
    }
}

#[cfg(test)]
#[path = "lanes/tests.rs"]
mod tests;
