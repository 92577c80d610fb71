//! What a kernel's grid is too coarse for, and a kernel that would keep it.

use std::fmt;

use core_rt::exact::{Exact20, Exact29};
use core_rt::kernel::{Kernel, Vertices};
use core_rt::num::{cross, sub};

use crate::grid::Grid;
use crate::model::{Model, Sphere};

/// Of so many triangles one may collapse without a word. One that does is thinner than a step of the grid, and its neighbours
/// close over it; where more do, they are neighbours, and shapes vanish.
const ONE_OF: u32 = 100;

/// With fewer bits for the geometry a warning is due: a step of the grid is then more than a 4096th of the scene, which is a
/// quarter of a pixel in a picture 1024 wide.
const FEW_BITS: u32 = 12;

/// A kernel that keeps some triangles or spheres where another keeps none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Keeper {
    /// Its name.
    pub kernel: &'static str,
    /// How many have a size on its grid.
    pub kept: u32,
}

/// Something of a scene that is lost on a kernel's grid. One line of text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Loss {
    /// Triangles with area in the file have none on the grid, and they are more than one in a hundred or all of a material.
    Triangles {
        /// How many of how many.
        share: [u32; 2],
        /// The materials of which nothing is left.
        materials: Vec<String>,
        /// The kernel.
        kernel: &'static str,
        /// Who keeps more, and how many it would lose.
        keeper: Option<(&'static str, u32)>,
    },
    /// Spheres whose radius is less than the kernel's least.
    Spheres {
        /// How many of how many.
        share: [u32; 2],
        /// The kernel.
        kernel: &'static str,
        /// Who keeps more, and how many it would lose.
        keeper: Option<(&'static str, u32)>,
    },
    /// The camera or a light is so far away that few bits are left for the geometry.
    Bits {
        /// Bits of the geometry, of the grid's.
        left: [u32; 2],
        /// The kernel.
        kernel: &'static str,
        /// Who keeps more, and how many.
        keeper: Option<(&'static str, u32)>,
    },
}

impl fmt::Display for Loss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Triangles { share: [lost, all], materials, kernel, keeper } => {
                let percent = f64::from(*lost) * 100.0 / f64::from(*all);
                write!(f, "{percent:.1} % of the triangles are too small for the grid of {kernel}")?;
                for (i, material) in materials.iter().take(3).enumerate() {
                    write!(f, "{} `{}`", if i == 0 { ", all of" } else { "," }, material.escape_debug())?;
                }
                if materials.len() > 3 {
                    write!(f, " and {} more", materials.len() - 3)?;
                }
                write_keeper(f, *keeper)
            }
            Self::Spheres { share: [lost, all], kernel, keeper } => {
                write!(f, "{lost} of {all} spheres are too small for the grid of {kernel} and were left out")?;
                write_keeper(f, *keeper)
            }
            Self::Bits { left: [left, all], kernel, keeper } => {
                write!(
                    f,
                    "the camera or a light is so far from the triangles that {left} of the {all} bits of {kernel} are left \
                     for them; "
                )?;
                if let Some((keeper, bits)) = keeper {
                    write!(f, "use {keeper}, which keeps {bits}, ")?;
                }
                write!(f, "bring it closer, or make the light directional")
            }
        }
    }
}

fn write_keeper(f: &mut fmt::Formatter<'_>, keeper: Option<(&'static str, u32)>) -> fmt::Result {
    match keeper {
        Some((keeper, 0)) => write!(f, "; {keeper} keeps them all"),
        Some((keeper, lost)) => write!(f, "; {keeper} keeps all but {lost}"),
        None => write!(f, ", and no kernel keeps more; make what is large smaller, or leave it out"),
    }
}

/// What a kernel's grid makes of a model.
struct Survey {
    kernel: &'static str,
    /// Triangles that have an area in the model.
    triangles: u32,
    /// Those of them that have none on the grid.
    lost: u32,
    /// Spheres.
    spheres: u32,
    /// Those of them that are too small for the grid.
    lost_spheres: u32,
    /// Materials, by number, of which nothing is left.
    materials: Vec<usize>,
    /// Bits of the geometry.
    bits: u32,
}

impl Survey {
    fn of(kernel: &'static str, radius_min: i32, model: &Model, grid: &Grid) -> Self {
        let is_kept = |sphere: &&Sphere| grid.ball(sphere).radius >= radius_min;
        let mut of_spheres = vec![false; model.materials.len()];
        for sphere in model.spheres.iter().filter(is_kept) {
            of_spheres[sphere.material as usize] = true;
        }
        let spheres = model.spheres.len() as u32;
        let mut counts = vec![[0u32; 2]; model.materials.len()];
        for (triangle, corners) in model.triangles.iter().zip(grid.snap(model).iter()) {
            let [a, b, c] = triangle.vertices.map(|v| model.positions[v as usize]);
            if (b - a).cross(c - a) != glam::DVec3::ZERO {
                let [all, lost] = &mut counts[triangle.material as usize];
                *all += 1;
                *lost += u32::from(!has_area(corners));
            }
        }
        Self {
            kernel,
            triangles: counts.iter().map(|[all, _]| all).sum(),
            lost: counts.iter().map(|[_, lost]| lost).sum(),
            spheres,
            lost_spheres: spheres - model.spheres.iter().filter(is_kept).count() as u32,
            materials: (0..)
                .zip(&counts)
                .filter(|&(i, [all, lost])| *all > 0 && all == lost && !of_spheres[i])
                .map(|(i, _)| i)
                .collect(),
            bits: grid.bits(model),
        }
    }

    /// The same on the kernel's own grid; `None` where it has none for the model.
    fn on_grid_of<K: Kernel>(model: &Model) -> Option<Self> {
        Some(Self::of(K::NAME, K::RADIUS_MIN, model, &Grid::fit::<K>(model).ok()?))
    }

    fn loses_shapes(&self) -> bool {
        !self.materials.is_empty() || u64::from(self.lost) * u64::from(ONE_OF) > u64::from(self.triangles)
    }
}

/// Whether a triangle on a grid has an area.
pub(super) fn has_area(corners: Vertices) -> bool {
    let [a, b, c] = corners.map(|v| v.map(i64::from));
    cross(sub(b, a), sub(c, a)) != [0; 3]
}

/// What kernels with finer grids than one of so many bits make of a model, the coarsest first.
fn finer(grid_bits: u32, model: &Model) -> impl Iterator<Item = Survey> {
    // One after the other, as far as they are asked for.
    let of_20 =
        (Exact20::GRID_BITS > grid_bits).then_some(Survey::on_grid_of::<Exact20> as fn(&Model) -> Option<Survey>);
    let of_29 =
        (Exact29::GRID_BITS > grid_bits).then_some(Survey::on_grid_of::<Exact29> as fn(&Model) -> Option<Survey>);
    [of_20, of_29].into_iter().flatten().filter_map(|survey| survey(model))
}

/// The first that is good enough, else the last; where that is better than none at all.
fn keeper(surveys: impl Iterator<Item = Survey>, enough: impl Fn(&Survey) -> bool) -> Option<Survey> {
    let mut last = None;
    for survey in surveys {
        if enough(&survey) {
            return Some(survey);
        }
        last = Some(survey);
    }
    last
}

/// What of a model is lost on the grid that a kernel of this name, with so many bits for coordinates and no smaller radii,
/// has for it.
#[must_use]
pub fn losses(kernel: &'static str, grid_bits: u32, radius_min: i32, model: &Model, grid: &Grid) -> Vec<Loss> {
    let own = Survey::of(kernel, radius_min, model, grid);
    let mut losses = Vec::new();
    if own.bits < FEW_BITS {
        let keeper = keeper(finer(grid_bits, model), |survey| survey.bits >= FEW_BITS);
        losses.push(Loss::Bits {
            left: [own.bits, grid_bits],
            kernel,
            keeper: keeper.filter(|survey| survey.bits > own.bits).map(|survey| (survey.kernel, survey.bits)),
        });
    }
    if own.loses_shapes() {
        let keeper = keeper(finer(grid_bits, model), |survey| !survey.loses_shapes());
        losses.push(Loss::Triangles {
            share: [own.lost, own.triangles],
            materials: own.materials.iter().map(|&i| model.materials[i].name.clone()).collect(),
            kernel,
            keeper: keeper.filter(|survey| survey.lost < own.lost).map(|survey| (survey.kernel, survey.lost)),
        });
    }
    if own.lost_spheres > 0 {
        let keeper = keeper(finer(grid_bits, model), |survey| survey.lost_spheres == 0);
        let keeper = keeper.filter(|survey| survey.lost_spheres < own.lost_spheres);
        losses.push(Loss::Spheres {
            share: [own.lost_spheres, own.spheres],
            kernel,
            keeper: keeper.map(|survey| (survey.kernel, survey.lost_spheres)),
        });
    }
    losses
}

/// The first kernel with a finer grid that keeps some triangles or spheres of a model, and how many.
pub(super) fn keeps_some(grid_bits: u32, model: &Model) -> Option<Keeper> {
    let kept = |survey: &Survey| survey.triangles - survey.lost + survey.spheres - survey.lost_spheres;
    finer(grid_bits, model)
        .find(|survey| kept(survey) > 0)
        .map(|survey| Keeper { kernel: survey.kernel, kept: kept(&survey) })
}
