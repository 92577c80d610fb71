//! Lights, background and picture settings.

use glam::DVec3;
use toml::Spanned;

use super::LARGEST;
use super::document::Document;
use super::error::{ImportError, Warning};
use super::schema::{FalloffToml, LightKindToml, LightToml, Number, TransferToml};
use crate::model::{Camera, Light, LightKind, RenderSettings, Transfer};
use crate::picture::{SIZES, size_is_allowed};

/// Picture size where none is given, pixels.
const SIZE: [u32; 2] = [640, 480];

impl Document {
    /// The lights; where there are none, a white one at the camera.
    pub(super) fn lights(&self, camera: &Camera) -> Result<Vec<Light>, ImportError> {
        if self.scene.light.is_empty() {
            return Ok(vec![Light { kind: LightKind::Point(camera.position), radiance: DVec3::ONE }]);
        }
        self.scene.light.iter().map(|light| self.light(light)).collect()
    }

    fn light(&self, table: &Spanned<LightToml>) -> Result<Light, ImportError> {
        let light = table.get_ref();
        if let Some(falloff) = &light.falloff
            && let FalloffToml::InverseSquare = falloff.get_ref()
        {
            let message = "inverse-square falloff is not supported yet; use \"none\"";
            return Err(self.error(falloff.span(), message));
        }
        if let Some(reach) = &light.reach {
            return Err(self.error(reach.span(), "reach goes with an inverse-square falloff"));
        }
        let kind = match (light.kind, &light.position, &light.direction) {
            (LightKindToml::Point, Some(position), None) => LightKind::Point(self.point(position)?),
            (LightKindToml::Directional, None, Some(direction)) => {
                LightKind::Directional(self.direction("direction", direction)?)
            }
            (LightKindToml::Point, _, _) => {
                let message = "a point light has a position, such as [0, 2, 1], and no direction";
                return Err(self.error(table.span(), message));
            }
            (LightKindToml::Directional, _, _) => {
                let message = "a directional light has a direction, such as [0, -1, 0], and no position";
                return Err(self.error(table.span(), message));
            }
        };
        let colour = self.colour("colour", LARGEST, light.colour.as_ref(), DVec3::ONE)?;
        let intensity = match &light.intensity {
            Some(intensity) if !(0.0..=LARGEST).contains(&intensity.get_ref().0) => {
                let message = format!("intensity of {}; it must be from 0 to {LARGEST:e}", intensity.get_ref().0);
                return Err(self.error(intensity.span(), message));
            }
            Some(intensity) => intensity.get_ref().0,
            None => 1.0,
        };
        Ok(Light { kind, radiance: intensity * colour })
    }

    /// What a ray that hits nothing sees.
    pub(super) fn background(&self) -> Result<DVec3, ImportError> {
        if let Some(sky) = &self.scene.background.sky {
            return Err(self.error(sky.span(), "sky is not supported yet; give a colour"));
        }
        let colour = self.scene.background.colour.as_ref();
        self.colour("background", LARGEST, colour, DVec3::ZERO)
    }

    /// Picture settings.
    pub(super) fn render(&self, warnings: &mut Vec<Warning>) -> Result<RenderSettings, ImportError> {
        let render = &self.scene.render;
        let size = match &render.size {
            Some(size) => self.size(size)?,
            None => SIZE,
        };
        if let Some(samples) = &render.samples
            && self.count("samples", 1.0, samples)? > 1.0
        {
            let line = self.line(samples.span());
            let message = "samples: more than one a pixel is not supported yet; drawn with one";
            warnings.push(Warning::line(&self.file, line, message));
        }
        if let Some(max_depth) = &render.max_depth {
            self.count("max_depth", 0.0, max_depth)?;
        }
        let transfer = match self.scene.transfer {
            TransferToml::Srgb => Transfer::Srgb,
            TransferToml::Linear => Transfer::Linear,
        };
        let ambient = self.colour("ambient", LARGEST, render.ambient.as_ref(), DVec3::ZERO)?;
        Ok(RenderSettings { size, ambient, transfer })
    }

    fn size(&self, size: &Spanned<Vec<Number>>) -> Result<[u32; 2], ImportError> {
        // Casting saturates: what is no size stays none.
        let sides: Vec<u32> =
            size.get_ref().iter().map(|side| if side.0.fract() == 0.0 { side.0 as u32 } else { 0 }).collect();
        match sides[..] {
            [width, height] if size_is_allowed(width, height) => Ok([width, height]),
            _ => {
                let message = format!("size must be a width and a height in whole pixels, such as [640, 480]; {SIZES}");
                Err(self.error(size.span(), message))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::import::testing::{refused, room, warnings};

    #[test]
    fn a_light_that_is_none_is_refused() {
        let point = "a point light has a position, such as [0, 2, 1], and no direction";
        let direction = "a directional light has a direction, such as [0, -1, 0], and no position";
        refused(&[
            ("[[light]]", &format!("2: {point}")),
            ("[[light]]\nposition = [0, 0, 0]\n[[light]]", &format!("4: {point}")),
            ("[[light]]\nposition = [0, 0, 0]\ndirection = [0, 1, 0]", &format!("2: {point}")),
            ("[[light]]\nkind = 'directional'\nposition = [0, 1, 0]", &format!("2: {direction}")),
            (
                "[[light]]\nkind = 'directional'\ndirection = [0, 0, 0]",
                "4: direction [0, 0, 0] is not a direction; give one of length 1 or so",
            ),
            (
                "[[light]]\nposition = [0, 0, 0]\nfalloff = 'inverse-square'",
                "4: inverse-square falloff is not supported yet; use \"none\"",
            ),
            ("[[light]]\nposition = [0, 0, 0]\nreach = 3", "4: reach goes with an inverse-square falloff"),
            ("[[light]]\nposition = [0, 0, 0]\nintensity = -1", "4: intensity of -1; it must be from 0 to 1e30"),
            (
                "[[light]]\nposition = [0, 0, 0]\ncolour = [1, 1, -1]",
                "4: colour [1, 1, -1] is out of range; each channel is from 0 to 1e30",
            ),
        ]);
    }

    #[test]
    fn a_picture_that_cannot_be_is_refused() {
        let size = "3: size must be a width and a height in whole pixels, such as [640, 480]; a picture \
                    has 1 to 16384 pixels a side, and at most 67108864 in all";
        refused(&[
            ("[render]\nsize = [0, 480]", size),
            ("[render]\nsize = [640, -480]", size),
            ("[render]\nsize = [640.5, 480]", size),
            ("[render]\nsize = [16385, 1]", size),
            ("[render]\nsize = [640]", size),
            ("[render]\nsize = [8192, 8193]", size),
            ("[render]\nsamples = 0", "3: samples of 0; it must be a whole number from 1"),
            ("[render]\nmax_depth = -1", "3: max_depth of -1; it must be a whole number from 0"),
            ("[render]\nambient = [-1, 0, 0]", "3: ambient [-1, 0, 0] is out of range; each channel is from 0 to 1e30"),
            ("[background]\nsky = [[0, 0, 0], [1, 1, 1]]", "3: sky is not supported yet; give a colour"),
            (
                "[background]\ncolour = [0, -1, 0]",
                "3: background [0, -1, 0] is out of range; each channel is from 0 to 1e30",
            ),
        ]);
        for size in [[16384, 4096], [1, 1]] {
            let model = room(&format!("[render]\nsize = {size:?}")).unwrap().model;
            assert_eq!(model.render.size, size);
        }
    }

    #[test]
    fn samples_are_accepted_with_a_warning() {
        let imported = room("[render]\nsamples = 4\nmax_depth = 0\n[material.wall]").unwrap();
        let expected = "built-in s.toml:3: samples: more than one a pixel is not supported yet; \
                        drawn with one";
        assert_eq!(warnings(&imported), [expected]);
    }
}
