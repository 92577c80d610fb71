//! What an MTL entry looks like: the table of `docs/SHADING.md`, in code.
//!
//! MTL by Wavefront's own specification ("Advanced Visualizer" manual, appendix B1), except where viewers agree on
//! something else.

use glam::DVec3;

use super::mtl::Entry;
use super::statement::{DEFAULT_EXPONENT, DEFAULT_IOR};
use crate::model::{DEFAULT_DIFFUSE, Lobe, Material, MaterialKind, Specular};

/// What `illum` makes of the rest.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Model {
    /// Diffuse light alone.
    Matt,
    /// And highlights.
    Glossy,
    /// And reflections.
    Reflecting,
    /// Reflections and refraction.
    Glass,
}

impl Entry {
    /// The material called `name`; its texture is left to be read.
    pub(super) fn material(&self, name: &str) -> Material {
        let model = self.model();
        let absent = if model == Model::Reflecting { DVec3::ONE } else { DVec3::ZERO };
        let colour = self.specular.unwrap_or(absent);
        let is_shiny = model != Model::Matt && colour != DVec3::ZERO;
        let specular = is_shiny.then(|| Specular { lobe: Lobe::BlinnPhong, exponent: self.exponent(), colour });
        let plain = Material {
            name: name.into(),
            colour: self.diffuse(),
            emission: self.emission.unwrap_or_default(),
            specular,
            ..Material::default()
        };
        let opaque = 1.0 - self.transparency;
        match model {
            Model::Glass => {
                let ior = self.ior.unwrap_or(DEFAULT_IOR);
                Material {
                    kind: MaterialKind::Dielectric,
                    colour: self.filter.unwrap_or(DVec3::ONE),
                    ior,
                    // Where there is no boundary Schlick's approximation sees one all the same.
                    weights: (ior == 1.0).then_some([0.0, 1.0, 0.0, 1.0]),
                    ..plain
                }
            }
            Model::Reflecting if is_shiny => {
                Material { weights: Some([opaque, 1.0, opaque, self.transparency]), ..plain }
            }
            _ if self.transparency > 0.0 => Material { weights: Some([opaque, 1.0, 0.0, self.transparency]), ..plain },
            _ => plain,
        }
    }

    /// The reflectance of diffuse light.
    pub(super) fn diffuse(&self) -> DVec3 {
        // A texture is the colour, and not of something grey.
        let absent = if self.texture.is_some() { 1.0 } else { DEFAULT_DIFFUSE };
        self.diffuse.unwrap_or(DVec3::splat(absent))
    }

    /// How narrow highlights are.
    pub(super) fn exponent(&self) -> u32 {
        self.exponent.unwrap_or(DEFAULT_EXPONENT)
    }

    fn model(&self) -> Model {
        match self.illum {
            Some(0 | 1) => Model::Matt,
            Some(3 | 5 | 8) => Model::Reflecting,
            Some(6 | 7) => Model::Glass,
            // "Glass on": of an entry that is not transparent otherwise.
            Some(4 | 9) if self.transparency == 0.0 => Model::Glass,
            Some(4) => Model::Reflecting,
            _ => Model::Glossy,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KS: DVec3 = DVec3::splat(0.5);

    fn entry(illum: Option<u8>) -> Entry {
        Entry { specular: Some(KS), exponent: Some(9), illum, ior: Some(1.25), ..Entry::default() }
    }

    #[test]
    fn what_illum_makes_of_a_material() {
        let look = |illum| {
            let Material { kind, weights, specular, ior, .. } = entry(illum).material("m");
            (kind, weights, specular.map(|s| (s.exponent, s.colour)), ior)
        };
        let shiny = Some((9, KS));
        let lambert = MaterialKind::Lambert;
        assert_eq!(look(Some(0)), (lambert, None, None, 1.0));
        assert_eq!(look(Some(1)), (lambert, None, None, 1.0));
        assert_eq!(look(Some(2)), (lambert, None, shiny, 1.0));
        assert_eq!(look(None), look(Some(2)));
        for mirror in [3, 5, 8] {
            assert_eq!(look(Some(mirror)), (lambert, Some([1.0, 1.0, 1.0, 0.0]), shiny, 1.0));
        }
        for glass in [4, 6, 7, 9] {
            assert_eq!(look(Some(glass)), (MaterialKind::Dielectric, None, shiny, 1.25));
        }
        assert_eq!(look(Some(10)), look(Some(2)), "10 casts shadows on what is invisible");
    }

    #[test]
    fn transparency_is_blending_and_not_glass() {
        let film = Entry { transparency: 0.25, ..Entry::default() }.material("m");
        assert_eq!((film.kind, film.weights, film.ior), (MaterialKind::Lambert, Some([0.75, 1.0, 0.0, 0.25]), 1.0));
        let tinted = Entry { transparency: 0.25, ..entry(Some(4)) }.material("m");
        assert_eq!((tinted.weights, tinted.ior), (Some([0.75, 1.0, 0.75, 0.25]), 1.0));
    }

    #[test]
    fn defaults() {
        let nothing = Entry::default().material("m");
        assert_eq!(nothing, Material { name: "m".into(), ..Material::default() });
        assert_eq!(Entry { illum: Some(5), ..Entry::default() }.material("m").specular.unwrap().colour, DVec3::ONE);
        let black = Entry { specular: Some(DVec3::ZERO), illum: Some(3), ..Entry::default() }.material("m");
        assert_eq!((black.specular, black.weights), (None, None), "what reflects nothing is no mirror");
        let glass = Entry { illum: Some(7), diffuse: Some(DVec3::ZERO), ..Entry::default() }.material("m");
        assert_eq!((glass.colour, glass.ior, glass.weights), (DVec3::ONE, 1.5, None));
        let gap = Entry { illum: Some(7), ior: Some(1.0), ..Entry::default() }.material("m");
        assert_eq!(gap.weights, Some([0.0, 1.0, 0.0, 1.0]));
        let painted = Entry { texture: Some("x.png".into()), ..Entry::default() }.material("m");
        assert_eq!(painted.colour, DVec3::ONE);
    }
}
