//! What a kernel's grid is too coarse for, and a kernel that would keep it.

use std::fmt;

use super::examiner::{Examiner, OnGrid};
use super::survey::{MOST_LIGHT, few, lost_boxes, too_strong};
use crate::grid::Grid;
use crate::model::Model;

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
    /// Surfaces that are apart in the file and may change sides on the grid.
    Layers {
        /// How many triangles of how many.
        share: [u32; 2],
        /// The kernel.
        kernel: &'static str,
        /// Who keeps more apart, and how many it would not.
        keeper: Option<(&'static str, u32)>,
    },
    /// Flat triangles that are so small that they face another way on the grid.
    Turned {
        /// How many of how many.
        share: [u32; 2],
        /// The kernel.
        kernel: &'static str,
        /// Who turns fewer, and how many.
        keeper: Option<(&'static str, u32)>,
    },
    /// The camera or a light is so close to a surface that it may be on its other side.
    Near {
        /// The kernel.
        kernel: &'static str,
        /// Who keeps it on its side.
        keeper: Option<&'static str>,
    },
    /// Triangles whose boxes are smaller than what the box test of a kernel of the 2009 report tells apart: it loses them.
    Boxes {
        /// How many of how many.
        share: [u32; 2],
        /// The kernel.
        kernel: &'static str,
    },
    /// Inverse-square lights that are stronger than what a blob holds. Others would be white all the same.
    Strength {
        /// How many lights.
        count: u32,
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
            Self::Layers { share: [lost, all], kernel, keeper } => {
                write!(
                    f,
                    "{lost} of {all} triangles are so close to another surface that the grid of {kernel} may put them on its \
                     other side"
                )?;
                write_keeper(f, *keeper)
            }
            Self::Turned { share: [lost, all], kernel, keeper } => {
                write!(f, "{lost} of {all} triangles are so small that they face another way on the grid of {kernel}")?;
                write_keeper(f, *keeper)
            }
            Self::Near { kernel, keeper } => {
                write!(
                    f,
                    "the camera or a light is so close to a surface that the grid of {kernel} may put it on the other side"
                )?;
                match keeper {
                    Some(keeper) => write!(f, "; {keeper} does not"),
                    None => write!(f, "; move it away"),
                }
            }
            Self::Boxes { share: [lost, all], kernel } => write!(
                f,
                "the boxes of {lost} of {all} triangles are smaller than what the box test of {kernel} tells apart, so that \
                 rays pass them; hanika-cons loses none"
            ),
            Self::Strength { count } => write!(
                f,
                "inverse-square lights of over {MOST_LIGHT} are drawn with that: {count}; make their reach longer instead"
            ),
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

/// What of a model is lost on the grid that a kernel of this name, with so many bits for coordinates and no smaller radii,
/// has for it.
#[must_use]
pub fn losses(kernel: &'static str, grid_bits: u32, radius_min: i32, model: &Model, grid: &Grid) -> Vec<Loss> {
    Examiner::new(model).losses(kernel, grid_bits, radius_min, grid)
}

impl Examiner<'_> {
    /// What is lost on the grid that a kernel of this name, with so many bits for coordinates and no smaller radii, has for the
    /// model.
    #[must_use]
    pub fn losses(&self, kernel: &'static str, grid_bits: u32, radius_min: i32, grid: &Grid) -> Vec<Loss> {
        let model = self.model;
        let made;
        let place = match self.known(kernel, grid) {
            Some(known) => known,
            None => {
                made = OnGrid::new(kernel, grid_bits, radius_min, model, *grid);
                &made
            }
        };
        let own = place.survey();
        let mut losses = Vec::new();
        if own.bits < FEW_BITS {
            let keeper = self.keeper(grid_bits, |other| other.survey().bits >= FEW_BITS);
            losses.push(Loss::Bits {
                left: [own.bits, grid_bits],
                kernel,
                keeper: keeper.map(|other| (other.kernel, other.survey().bits)).filter(|&(_, bits)| bits > own.bits),
            });
        }
        if own.loses_shapes() {
            let keeper = self.keeper(grid_bits, |other| !other.survey().loses_shapes());
            losses.push(Loss::Triangles {
                share: [own.lost, own.triangles],
                materials: own.materials.iter().map(|&i| model.materials[i].name.clone()).collect(),
                kernel,
                keeper: fewer(keeper, own.lost, |other| other.survey().lost),
            });
        }
        if own.lost_spheres > 0 {
            let keeper = self.keeper(grid_bits, |other| other.survey().lost_spheres == 0);
            losses.push(Loss::Spheres {
                share: [own.lost_spheres, own.spheres],
                kernel,
                keeper: fewer(keeper, own.lost_spheres, |other| other.survey().lost_spheres),
            });
        }
        // Where shapes are lost already, what becomes of the rest is no news.
        let told = !losses.is_empty();
        if !told && place.layers().are_merged() {
            let keeper = self.keeper(grid_bits, |other| !other.layers().are_merged());
            let merged = place.layers().merged;
            losses.push(Loss::Layers {
                share: [merged, own.triangles],
                kernel,
                keeper: fewer(keeper, merged, |other| other.layers().merged),
            });
        }
        if !told && own.turns_shapes() {
            let keeper =
                self.keeper(grid_bits, |other| !other.survey().turns_shapes() && !other.survey().loses_shapes());
            losses.push(Loss::Turned {
                share: own.turned,
                kernel,
                keeper: fewer(keeper, own.turned[0], |other| other.survey().turned[0]),
            });
        }
        if !told && own.is_near {
            let keeper = self.keeper(grid_bits, |other| !other.survey().is_near);
            let keeper = keeper.filter(|other| !other.survey().is_near).map(|other| other.kernel);
            losses.push(Loss::Near { kernel, keeper });
        }
        let boxes = lost_boxes(kernel, &grid.snap(model));
        if !few(boxes, own.triangles) {
            losses.push(Loss::Boxes { share: [boxes, own.triangles], kernel });
        }
        match too_strong(model) {
            0 => {}
            count => losses.push(Loss::Strength { count }),
        }
        losses
    }
}

/// A kernel, and how many it loses, where these are fewer.
fn fewer(keeper: Option<&OnGrid<'_>>, than: u32, count: impl Fn(&OnGrid<'_>) -> u32) -> Option<(&'static str, u32)> {
    keeper.map(|keeper| (keeper.kernel, count(keeper))).filter(|&(_, count)| count < than)
}

/// The first kernel with a finer grid that keeps some triangles or spheres of a model, and how many.
pub(super) fn keeps_some(grid_bits: u32, model: &Model) -> Option<Keeper> {
    let kept = |other: &OnGrid<'_>| {
        let survey = other.survey();
        survey.triangles - survey.lost + survey.spheres - survey.lost_spheres
    };
    Examiner::new(model)
        .finer(grid_bits)
        .map(|other| Keeper { kernel: other.kernel, kept: kept(other) })
        .find(|keeper| keeper.kept > 0)
}
