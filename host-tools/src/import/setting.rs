//! Lights, background and picture settings.

use core_rt::samples::MAX_SAMPLES;
use glam::DVec3;
use toml::Spanned;

use super::document::Document;
use super::error::ImportError;
use super::schema::{FalloffToml, FilterToml, FormatToml, LightKindToml, LightToml, Number, TransferToml};
use super::{LARGEST, SMALLEST};
use crate::model::{Background, Camera, Falloff, Filter, Format, Light, LightKind, RenderSettings, Transfer};
use crate::picture::{SIZES, size_is_allowed};

/// Camera rays a pixel at most.
pub const MOST_SAMPLES: u32 = MAX_SAMPLES as u32;
/// Reflections and refractions of a ray at most.
pub const GREATEST_DEPTH: u32 = 64;

impl Document {
    /// The lights; where there are none, a white one at the camera.
    pub(super) fn lights(&self, camera: &Camera) -> Result<Vec<Light>, ImportError> {
        if self.scene.light.is_empty() {
            return Ok(vec![Light::new(LightKind::Point(camera.position), DVec3::ONE)]);
        }
        self.scene.light.iter().map(|light| self.light(light)).collect()
    }

    fn light(&self, table: &Spanned<LightToml>) -> Result<Light, ImportError> {
        let light = table.get_ref();
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
        Ok(Light { kind, radiance: intensity * colour, falloff: self.falloff(light, kind)? })
    }

    fn falloff(&self, light: &LightToml, kind: LightKind) -> Result<Falloff, ImportError> {
        let falloff = light.falloff.as_ref();
        let Some(fades) = falloff.filter(|falloff| matches!(falloff.get_ref(), FalloffToml::InverseSquare)) else {
            return match &light.reach {
                Some(reach) => Err(self.error(reach.span(), "reach goes with an inverse-square falloff")),
                None => Ok(Falloff::None),
            };
        };
        if let LightKind::Directional(_) = kind {
            return Err(self.error(fades.span(), "a directional light comes from no place, and has no falloff"));
        }
        let Some(reach) = &light.reach else {
            let message = "an inverse-square falloff has a reach: at what distance the light is as bright as it says";
            return Err(self.error(fades.span(), message));
        };
        let Number(value) = *reach.get_ref();
        if !(SMALLEST..=LARGEST).contains(&value) {
            let message = format!("reach of {value}; it must be above 0 and at most {LARGEST:e}");
            return Err(self.error(reach.span(), message));
        }
        Ok(Falloff::InverseSquare { reach: value })
    }

    /// What a ray that hits nothing sees.
    pub(super) fn background(&self) -> Result<Background, ImportError> {
        let colour = self.scene.background.colour.as_ref();
        let Some(sky) = &self.scene.background.sky else {
            return Ok(self.colour("background", LARGEST, colour, DVec3::ZERO)?.into());
        };
        if let Some(colour) = colour {
            return Err(self.error(colour.span(), "a background is a colour or a sky, not both"));
        }
        let [bottom, top] = sky.get_ref().map(|vector| Spanned::new(sky.span(), vector));
        Ok(Background::Sky {
            bottom: self.colour("sky", LARGEST, Some(&bottom), DVec3::ZERO)?,
            top: self.colour("sky", LARGEST, Some(&top), DVec3::ZERO)?,
        })
    }

    /// Picture settings.
    pub(super) fn render(&self) -> Result<RenderSettings, ImportError> {
        let render = &self.scene.render;
        let size = match &render.size {
            Some(size) => self.size(size)?,
            None => RenderSettings::default().size,
        };
        let default = RenderSettings::default();
        let samples = match &render.samples {
            Some(samples) => self.count("samples", 1..=MOST_SAMPLES, samples)?,
            None => default.samples,
        };
        let paths = render.paths.unwrap_or(default.paths);
        let max_depth = match &render.max_depth {
            Some(max_depth) => self.count("max_depth", 0..=GREATEST_DEPTH, max_depth)?,
            None => default.max_depth,
        };
        let transfer = match self.scene.transfer {
            TransferToml::Srgb => Transfer::Srgb,
            TransferToml::Linear => Transfer::Linear,
        };
        let ambient = self.colour("ambient", LARGEST, render.ambient.as_ref(), DVec3::ZERO)?;
        let shadows = render.shadows.unwrap_or(default.shadows);
        let filter = match render.filter {
            FilterToml::Bilinear => Filter::Bilinear,
            FilterToml::Nearest => Filter::Nearest,
        };
        let format = match render.format {
            FormatToml::Rgb888 => Format::Rgb888,
            FormatToml::Rgb565 => Format::Rgb565,
            FormatToml::Gray8 => Format::Gray8,
        };
        Ok(RenderSettings { size, samples, paths, max_depth, ambient, shadows, transfer, filter, format })
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
    use super::*;
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
                "4: an inverse-square falloff has a reach: at what distance the light is as bright as it says",
            ),
            (
                "[[light]]\nposition = [0, 0, 0]\nfalloff = 'inverse-square'\nreach = 0",
                "5: reach of 0; it must be above 0 and at most 1e30",
            ),
            (
                "[[light]]\nkind = 'directional'\ndirection = [0, -1, 0]\nfalloff = 'inverse-square'\nreach = 1",
                "5: a directional light comes from no place, and has no falloff",
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
            ("[render]\nsamples = 0", "3: samples of 0; it must be a whole number from 1 to 1024"),
            ("[render]\nmax_depth = -1", "3: max_depth of -1; it must be a whole number from 0 to 64"),
            ("[render]\nambient = [-1, 0, 0]", "3: ambient [-1, 0, 0] is out of range; each channel is from 0 to 1e30"),
            ("[render]\nmax_depth = 65", "3: max_depth of 65; it must be a whole number from 0 to 64"),
            ("[render]\nsamples = 1.5", "3: samples of 1.5; it must be a whole number from 1 to 1024"),
            ("[render]\nfilter = 'cubic'", "3: unknown value `cubic`; the nearest known one is `bilinear`"),
            (
                "[background]\nsky = [[0, 0, 0], [1, -1, 1]]",
                "3: sky [1, -1, 1] is out of range; each channel is from 0 to 1e30",
            ),
            (
                "[background]\nsky = [[0, 0, 0], [1, 1, 1]]\ncolour = [0, 0, 0]",
                "4: a background is a colour or a sky, not both",
            ),
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
    fn settings_reach_the_model() {
        let lines = "[render]\nsamples = 4\npaths = true\nmax_depth = 0\nfilter = 'nearest'\n[background]\nsky = [[1, 2, 3], [4, 5, 6]]\n\
                     [[light]]\nposition = [0, 0, 0]\nfalloff = 'inverse-square'\nreach = 3\n[material.wall]";
        let imported = room(lines).unwrap();
        assert_eq!(warnings(&imported), Vec::<String>::new());
        let model = imported.model;
        assert!(model.render.paths);
        assert_eq!((model.render.samples, model.render.max_depth, model.render.filter), (4, 0, Filter::Nearest));
        assert_eq!(model.lights[0].falloff, Falloff::InverseSquare { reach: 3.0 });
        let [bottom, top] = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]].map(DVec3::from_array);
        assert_eq!(model.background, Background::Sky { bottom, top });
    }
}
