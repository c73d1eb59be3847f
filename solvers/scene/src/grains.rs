//! The grains of a scene: shared by all copies of it until one of them changes its own.

use crate::scene::Grain;
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// The grains of a scene. A copy costs nothing; whoever changes one has grains of its own from then on.
#[derive(Clone, Default, PartialEq)]
pub struct Grains(Arc<Vec<Grain>>);

impl Grains {
    /// Whether they are the same ones in memory: neither of two copies has changed its own.
    #[must_use]
    pub fn are_shared_with(&self, others: &Self) -> bool {
        Arc::ptr_eq(&self.0, &others.0)
    }
}

impl From<Vec<Grain>> for Grains {
    fn from(grains: Vec<Grain>) -> Self {
        Self(Arc::new(grains))
    }
}

impl FromIterator<Grain> for Grains {
    fn from_iter<I: IntoIterator<Item = Grain>>(grains: I) -> Self {
        grains.into_iter().collect::<Vec<_>>().into()
    }
}

impl Deref for Grains {
    type Target = Vec<Grain>;

    fn deref(&self) -> &Vec<Grain> {
        &self.0
    }
}

impl DerefMut for Grains {
    fn deref_mut(&mut self) -> &mut Vec<Grain> {
        Arc::make_mut(&mut self.0)
    }
}

impl<'g> IntoIterator for &'g Grains {
    type Item = &'g Grain;
    type IntoIter = std::slice::Iter<'g, Grain>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl<'g> IntoIterator for &'g mut Grains {
    type Item = &'g mut Grain;
    type IntoIter = std::slice::IterMut<'g, Grain>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter_mut()
    }
}

/// As the list that they are: fingerprints of scenes are taken of this text.
impl fmt::Debug for Grains {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(formatter)
    }
}
