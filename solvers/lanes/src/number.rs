//! Interface for computing with one number or with several numbers at a time.

use crate::{FourLanes, LANES, Lanes, WIDEST};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// One number, or several numbers at a time.
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
    /// One flag per number.
    type Mask: Copy;

    /// Returns a constant of the same type, with the same value in every lane.
    #[must_use]
    fn like(self, value: f64) -> Self;
    /// Returns the number in the first lane.
    fn first(self) -> f64;
    /// Returns the square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Returns the mask of `self < bound`.
    fn below(self, bound: Self) -> Self::Mask;
    /// Returns `yes` where the mask is set, otherwise `no`.
    #[must_use]
    fn choose(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Returns true if any flag of a mask is set. `self` only selects the type.
    fn anywhere(self, mask: Self::Mask) -> bool;

    /// Returns `yes` where `self` is less than `bound`, otherwise `no`.
    #[must_use]
    #[inline(always)]
    fn pick_below(self, bound: Self, yes: Self, no: Self) -> Self {
        Self::choose(self.below(bound), yes, no)
    }

    /// Returns the larger of both numbers; `self` if neither is larger.
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

/// Several numbers in a register, with their backend.
#[derive(Clone, Copy)]
pub struct SimdPack<L: Lanes> {
    lanes: L,
    register: L::Register,
}

/// Mask for several numbers, with their backend.
#[derive(Clone, Copy)]
pub struct SimdMask<L: Lanes> {
    lanes: L,
    mask: L::Mask,
}

impl<L: Lanes> SimdMask<L> {
    /// Returns the mask as bits, with the first lane as the lowest bit.
    #[inline(always)]
    pub fn bits(self) -> u32 {
        self.lanes.bits(self.mask)
    }
}

impl<L: Lanes> SimdPack<L> {
    /// Wraps the numbers of a register.
    #[inline(always)]
    pub fn new(lanes: L, register: L::Register) -> Self {
        Self { lanes, register }
    }

    /// Returns the same number in every lane.
    #[inline(always)]
    pub fn splat(lanes: L, value: f64) -> Self {
        Self { lanes, register: lanes.splat(value) }
    }

    /// Loads the first numbers of `from`, one per lane.
    #[inline(always)]
    pub fn load(lanes: L, from: &[f64; WIDEST]) -> Self {
        Self { lanes, register: lanes.load(from) }
    }

    /// Returns the register.
    #[inline(always)]
    pub fn register(self) -> L::Register {
        self.register
    }

    /// Returns the number of each lane at the start of an array. The remaining entries are zero.
    #[inline(always)]
    pub fn store(self) -> [f64; WIDEST] {
        self.lanes.store(self.register)
    }

    /// Returns three packs, each multiplied by `by`.
    #[inline(always)]
    #[must_use]
    pub fn scaled([a, b, c]: [Self; 3], by: Self) -> [Self; 3] {
        [a * by, b * by, c * by]
    }
}

impl<L: FourLanes> SimdPack<L> {
    /// Creates a pack from one number per lane.
    #[inline(always)]
    pub fn four(lanes: L, values: [f64; LANES]) -> Self {
        Self { lanes, register: lanes.register(values) }
    }

    /// Returns the numbers of all lanes.
    #[inline(always)]
    pub fn values(self) -> [f64; LANES] {
        self.lanes.values(self.register)
    }

    /// Returns the sum over the lanes of each of four packs.
    #[inline(always)]
    #[must_use]
    pub fn sums(numbers: [Self; LANES]) -> [f64; LANES] {
        let [a, b, c, d] = numbers;
        a.lanes.sums([a.register, b.register, c.register, d.register])
    }
}

impl<L: Lanes> Number for SimdPack<L> {
    type Mask = SimdMask<L>;

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
    fn below(self, bound: Self) -> SimdMask<L> {
        SimdMask { lanes: self.lanes, mask: self.lanes.below(self.register, bound.register) }
    }
    #[inline(always)]
    fn choose(mask: SimdMask<L>, yes: Self, no: Self) -> Self {
        Self { register: mask.lanes.choose(mask.mask, yes.register, no.register), ..yes }
    }
    #[inline(always)]
    fn anywhere(self, mask: SimdMask<L>) -> bool {
        mask.bits() != 0
    }
}

/// Implements an operator for two packs, and for a pack and a constant.
macro_rules! operator {
    ($Operator:ident, $operator:ident) => {
        impl<L: Lanes> $Operator for SimdPack<L> {
            type Output = Self;
            #[inline(always)]
            fn $operator(self, other: Self) -> Self {
                Self { register: self.lanes.$operator(self.register, other.register), ..self }
            }
        }
        impl<L: Lanes> $Operator<f64> for SimdPack<L> {
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

impl<L: Lanes> Neg for SimdPack<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // The difference 0 − x would give +0 for x = +0. Therefore the sign is changed by multiplication.
        self * -1.0
    }
}
