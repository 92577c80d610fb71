//! A model on several kernels' grids: each is looked at once, and for no more than what is asked.

use std::cell::OnceCell;

use core_rt::exact::{Exact20, Exact29};
use core_rt::kernel::Kernel;

use super::layers::Layers;
use super::survey::Survey;
use crate::grid::Grid;
use crate::model::Model;

/// A model on the grid of a kernel.
pub(super) struct OnGrid<'m> {
    pub(super) kernel: &'static str,
    pub(super) grid_bits: u32,
    radius_min: i32,
    model: &'m Model,
    pub(super) grid: Grid,
    survey: OnceCell<Survey>,
    layers: OnceCell<Layers>,
}

impl<'m> OnGrid<'m> {
    pub(super) fn new(kernel: &'static str, grid_bits: u32, radius_min: i32, model: &'m Model, grid: Grid) -> Self {
        Self { kernel, grid_bits, radius_min, model, grid, survey: OnceCell::new(), layers: OnceCell::new() }
    }

    /// On the kernel's own grid; `None` where it has none for the model.
    fn of<K: Kernel>(model: &'m Model) -> Option<Self> {
        Some(Self::new(K::NAME, K::GRID_BITS, K::RADIUS_MIN, model, Grid::fit::<K>(model).ok()?))
    }

    pub(super) fn survey(&self) -> &Survey {
        self.survey.get_or_init(|| Survey::of(self.radius_min, self.model, &self.grid))
    }

    pub(super) fn layers(&self) -> &Layers {
        self.layers.get_or_init(|| Layers::of(self.model, &self.grid))
    }
}

/// What kernels' grids make of a model.
pub struct Examiner<'m> {
    pub(super) model: &'m Model,
    /// The grids of kernels that may keep what others lose, the coarsest first.
    keepers: Vec<OnGrid<'m>>,
}

impl<'m> Examiner<'m> {
    /// Of a model.
    #[must_use]
    pub fn new(model: &'m Model) -> Self {
        let keepers = [OnGrid::of::<Exact20>(model), OnGrid::of::<Exact29>(model)];
        Self { model, keepers: keepers.into_iter().flatten().collect() }
    }

    /// The model on a grid that is looked at for others too.
    pub(super) fn known(&self, kernel: &str, grid: &Grid) -> Option<&OnGrid<'m>> {
        self.keepers.iter().find(|known| known.kernel == kernel && known.grid == *grid)
    }

    /// On grids that are finer than one of so many bits, the coarsest first.
    pub(super) fn finer(&self, grid_bits: u32) -> impl Iterator<Item = &OnGrid<'m>> {
        self.keepers.iter().filter(move |known| known.grid_bits > grid_bits)
    }

    /// The first of these that is good enough, else the last; where that is better than none at all.
    pub(super) fn keeper(&self, grid_bits: u32, enough: impl Fn(&OnGrid<'m>) -> bool) -> Option<&OnGrid<'m>> {
        self.finer(grid_bits).find(|known| enough(known)).or_else(|| self.finer(grid_bits).last())
    }
}

impl std::fmt::Debug for Examiner<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Examiner").finish_non_exhaustive()
    }
}
