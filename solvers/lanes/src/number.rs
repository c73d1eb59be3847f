//! A number, or several at a time.

use crate::{FourLanes, LANES, Lanes, WIDEST};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number, or several.
pub trait Number:
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
    /// An answer for each of them.
    type Mask: Copy;

    /// A constant, to compute with this one.
    #[must_use]
    fn like(self, value: f64) -> Self;
    /// The number, that of the first lane.
    fn first(self) -> f64;
    /// The square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Where this is less than `bound`.
    fn below(self, bound: Self) -> Self::Mask;
    /// `yes` where it is so, else `no`.
    #[must_use]
    fn choose(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Whether it is so anywhere. `like` is any number.
    fn anywhere(self, mask: Self::Mask) -> bool;

    /// `yes` where this is less than `bound`, else `no`.
    #[must_use]
    #[inline(always)]
    fn pick_below(self, bound: Self, yes: Self, no: Self) -> Self {
        Self::choose(self.below(bound), yes, no)
    }

    /// The larger of both, this one where they are alike.
    #[must_use]
    #[inline(always)]
    fn at_least(self, other: Self) -> Self {
        Self::choose(self.below(other), other, self)
    }
}

impl Number for f64 {
    type Mask = bool;

    #[inline(always)]
    fn like(self, value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn first(self) -> f64 {
        self
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    #[inline(always)]
    fn below(self, bound: Self) -> bool {
        self < bound
    }
    #[inline(always)]
    fn choose(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn anywhere(self, mask: bool) -> bool {
        mask
    }
}

/// Several numbers with what computes with them.
#[derive(Clone, Copy)]
pub struct Wide<L: Lanes> {
    lanes: L,
    register: L::Register,
}

/// An answer for each of several numbers, with what computes with them.
#[derive(Clone, Copy)]
pub struct WideMask<L: Lanes> {
    lanes: L,
    mask: L::Mask,
}

impl<L: Lanes> WideMask<L> {
    /// The answers as bits, that of the first lane lowest.
    #[inline(always)]
    pub fn bits(self) -> u32 {
        self.lanes.bits(self.mask)
    }
}

impl<L: Lanes> Wide<L> {
    /// The numbers of a register.
    #[inline(always)]
    pub fn new(lanes: L, register: L::Register) -> Self {
        Self { lanes, register }
    }

    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(lanes: L, value: f64) -> Self {
        Self { lanes, register: lanes.splat(value) }
    }

    /// The first numbers of a row.
    #[inline(always)]
    pub fn load(lanes: L, from: &[f64; WIDEST]) -> Self {
        Self { lanes, register: lanes.load(from) }
    }

    /// The register.
    #[inline(always)]
    pub fn register(self) -> L::Register {
        self.register
    }

    /// The number in each lane, in the first of a row.
    #[inline(always)]
    pub fn store(self) -> [f64; WIDEST] {
        self.lanes.store(self.register)
    }

    /// Three numbers, each times another.
    #[inline(always)]
    #[must_use]
    pub fn scaled([a, b, c]: [Self; 3], by: Self) -> [Self; 3] {
        [a * by, b * by, c * by]
    }
}

impl<L: FourLanes> Wide<L> {
    /// A number for each lane.
    #[inline(always)]
    pub fn four(lanes: L, values: [f64; LANES]) -> Self {
        Self { lanes, register: lanes.of(values) }
    }

    /// The number in each lane.
    #[inline(always)]
    pub fn values(self) -> [f64; LANES] {
        self.lanes.values(self.register)
    }

    /// The sums over the lanes of each.
    #[inline(always)]
    #[must_use]
    pub fn sums(of: [Self; LANES]) -> [f64; LANES] {
        let [a, b, c, d] = of;
        a.lanes.sums([a.register, b.register, c.register, d.register])
    }
}

impl<L: Lanes> Number for Wide<L> {
    type Mask = WideMask<L>;

    #[inline(always)]
    fn like(self, value: f64) -> Self {
        Self::splat(self.lanes, value)
    }
    #[inline(always)]
    fn first(self) -> f64 {
        self.store()[0]
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self { register: self.lanes.sqrt(self.register), ..self }
    }
    #[inline(always)]
    fn below(self, bound: Self) -> WideMask<L> {
        WideMask { lanes: self.lanes, mask: self.lanes.below(self.register, bound.register) }
    }
    #[inline(always)]
    fn choose(mask: WideMask<L>, yes: Self, no: Self) -> Self {
        Self { register: mask.lanes.choose(mask.mask, yes.register, no.register), ..yes }
    }
    #[inline(always)]
    fn anywhere(self, mask: WideMask<L>) -> bool {
        mask.bits() != 0
    }
}

/// An operator on several numbers, and on several numbers and a constant.
macro_rules! operator {
    ($Operator:ident, $operator:ident) => {
        impl<L: Lanes> $Operator for Wide<L> {
            type Output = Self;
            #[inline(always)]
            fn $operator(self, other: Self) -> Self {
                Self { register: self.lanes.$operator(self.register, other.register), ..self }
            }
        }
        impl<L: Lanes> $Operator<f64> for Wide<L> {
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

impl<L: Lanes> Neg for Wide<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // Not 0 − x, which has another zero.
        self * -1.0
    }
}
