//! What a `[material.NAME]` makes of a material: `docs/SHADING.md` has the defaults in a table.

use glam::DVec3;

use super::LARGEST;
use super::document::Document;
use super::error::ImportError;
use super::mtl::Entry;
use super::schema::{CheckerToml, MaterialKindToml, MaterialToml, Number, SpecularToml};
use super::statement::{DEFAULT_IOR, IORS, LARGEST_EXPONENT};
use crate::model::{Checker, DEFAULT_DIFFUSE, Lobe, Material, MaterialKind, Specular};

impl Document {
    /// The material called `name`, of which MTL says `entry`, as `change` changes it.
    pub(super) fn change(
        &self,
        name: &str,
        entry: Option<&Entry>,
        change: &MaterialToml,
    ) -> Result<Material, ImportError> {
        let nothing = Entry::default();
        let mtl = entry.unwrap_or(&nothing);
        let mut material = mtl.material(name);
        if let Some(kind) = change.kind {
            material.kind = match kind {
                MaterialKindToml::Lambert => MaterialKind::Lambert,
                MaterialKindToml::Metal => MaterialKind::Metal,
                MaterialKindToml::Dielectric => MaterialKind::Dielectric,
                MaterialKindToml::Mirror => MaterialKind::Mirror,
            };
            material.colour = match (kind, entry) {
                // Kd is not what glass lets through.
                (MaterialKindToml::Dielectric, _) | (MaterialKindToml::Mirror, None) => DVec3::ONE,
                (_, None) => DVec3::splat(DEFAULT_DIFFUSE),
                (_, Some(entry)) => entry.diffuse(),
            };
            material.weights = None;
            material.specular = None;
            let absent = if kind == MaterialKindToml::Dielectric { DEFAULT_IOR } else { 1.0 };
            material.ior = mtl.ior.filter(|_| kind == MaterialKindToml::Dielectric).unwrap_or(absent);
        }
        material.colour = self.colour("colour", 1.0, change.colour.as_ref(), material.colour)?;
        if let Some(ior) = &change.ior {
            material.ior = ior.get_ref().0;
            if !IORS.contains(&material.ior) {
                let message = format!("ior of {}; it must be from {} to {}", material.ior, IORS.start(), IORS.end());
                return Err(self.error(ior.span(), message));
            }
        }
        if let Some(weights) = &change.weights {
            material.weights = Some(self.weights(weights)?);
        }
        material.specular = self.specular(mtl, change, &material)?;
        if let Some(checker) = &change.checker {
            let CheckerToml { size, other } = checker.get_ref();
            if size.0 <= 0.0 {
                let message = format!("checker size of {}; it must be above 0", size.0);
                return Err(self.error(checker.span(), message));
            }
            let other = self.colour("other", 1.0, Some(other), DVec3::ZERO)?;
            material.checker = Some(Checker { size: size.0, other });
        }
        material.tinted_shadow = change.tinted_shadow.unwrap_or(false);
        if let Some(roughness) = &change.roughness {
            material.roughness = roughness.get_ref().0;
            if !(0.0..=1.0).contains(&material.roughness) {
                let message = format!("roughness of {}; it must be from 0 to 1", material.roughness);
                return Err(self.error(roughness.span(), message));
            }
        }
        Ok(material)
    }

    /// The highlights of a material that is whole otherwise: where something asks for them.
    fn specular(
        &self,
        mtl: &Entry,
        change: &MaterialToml,
        material: &Material,
    ) -> Result<Option<Specular>, ImportError> {
        let weight = material.weights.map_or(0.0, |[_, specular, ..]| specular);
        let is_asked_for = change.specular.is_some() || change.exponent.is_some() || weight > 0.0;
        let is_tinted = matches!(material.kind, MaterialKind::Metal | MaterialKind::Mirror);
        let default = Specular {
            lobe: Lobe::default(),
            exponent: mtl.exponent(),
            colour: if is_tinted { material.colour } else { DVec3::ONE },
        };
        let wanted = is_asked_for || material.kind == MaterialKind::Metal;
        let Some(mut specular) = material.specular.or(wanted.then_some(default)) else {
            return Ok(None);
        };
        match change.specular {
            Some(SpecularToml::BlinnPhong) => specular.lobe = Lobe::BlinnPhong,
            Some(SpecularToml::Phong) => specular.lobe = Lobe::Phong,
            None => {}
        }
        if let Some(exponent) = &change.exponent {
            let Number(value) = *exponent.get_ref();
            if !(1.0..=LARGEST_EXPONENT).contains(&value) {
                let message = format!("exponent of {value}; it must be from 1 to {LARGEST_EXPONENT}");
                return Err(self.error(exponent.span(), message));
            }
            specular.exponent = value.round() as u32;
        }
        Ok(Some(specular))
    }

    /// The shares of diffuse, specular, reflected and refracted light.
    fn weights(&self, weights: &toml::Spanned<[Number; 4]>) -> Result<[f64; 4], ImportError> {
        let shares = weights.get_ref().map(|Number(share)| share);
        if let Some(wrong) = shares.iter().find(|share| !(0.0..=LARGEST).contains(*share)) {
            let message = format!("a weight of {wrong}; weights are from 0 to {LARGEST:e}");
            return Err(self.error(weights.span(), message));
        }
        let [_, _, reflected, refracted] = shares;
        if reflected + refracted > 1.0 {
            let message = format!(
                "weights of reflected and refracted light are {} together; they must be at most 1, or mirrors that face \
                 each other make light",
                reflected + refracted
            );
            return Err(self.error(weights.span(), message));
        }
        Ok(shares)
    }
}
