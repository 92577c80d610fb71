//! The spheres of a scene file.

use super::LARGEST;
use super::SMALLEST;
use super::document::Document;
use super::error::ImportError;
use super::materials::Names;
use crate::model::Sphere;

impl Document {
    /// The spheres; the names of their materials are added to `names`.
    pub(super) fn spheres(&self, names: &mut Names) -> Result<Vec<Sphere>, ImportError> {
        let mut spheres = Vec::new();
        for table in &self.scene.sphere {
            let sphere = table.get_ref();
            let centre = self.point(&sphere.centre)?;
            let radius = sphere.radius.get_ref().0;
            if !(SMALLEST..=LARGEST).contains(&radius) {
                let message = format!("radius of {radius}; it must be above 0 and at most {LARGEST:e}");
                return Err(self.error(sphere.radius.span(), message));
            }
            let material = match &sphere.material {
                Some(name) => names.of_sphere(name.get_ref(), self.line(name.span())),
                None => names.of_sphere("", self.line(table.span())),
            };
            spheres.push(Sphere { centre, radius, material });
        }
        Ok(spheres)
    }
}
