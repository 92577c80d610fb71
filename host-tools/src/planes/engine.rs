//! The tracer of 1994 as one kernel among others, for reports and for the stiff cases.
//!
//! Its blob is [`planes_rt::blob`]'s. Of a header that other kernels have, only size and needs are anything here: it needs nothing that a
//! profile switches.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::time::Instant;

use core_rt::arithmetic::Arithmetic;
use core_rt::blob::{BlobError, Counts as Records, Header, SourceGrid};
use core_rt::camera::CameraHeader;
use core_rt::colour::{Radiance, Transfer};
use core_rt::format::Format;
use core_rt::kernel::NONE;
use core_rt::profile::Needs;
use core_rt::stats::Counts;
use planes_rt::blob::{KERNEL, ReadError, read};
use planes_rt::pixel;
use planes_rt::scene::{Sample, Scene};
use planes_simd::Lockstep;

use super::scene::{Options as Words, Planes};
use super::stage::Staged;
use super::trace::Tracer;
use super::{NAME, Way, blob, light, lookups, picture};
use crate::engine::{Engine, Sizes};
use crate::grid::Grid;
use crate::model::{self, Model};
use crate::needs::Asked;
use crate::prepare::{Degenerates, Options, PrepareError, Prepared, transfer};
use crate::render::{Progress, Rendered};
use crate::stage::Stage;
use crate::trace::{Trace, source_grid};
use crate::witness::{Place, Seen};

/// The kernel.
#[derive(Clone, Copy, Debug)]
pub struct Planes12;

/// A scene that is no scene of this kernel is a damaged blob to others.
fn opened(blob: &[u8]) -> Result<(Scene<'_>, model::Transfer), BlobError> {
    match read(blob) {
        Ok((scene, Transfer::Srgb)) => Ok((scene, model::Transfer::Srgb)),
        Ok((scene, Transfer::Linear)) => Ok((scene, model::Transfer::Linear)),
        Err(ReadError::Blob(error)) => Err(error),
        Err(ReadError::Widths(_) | ReadError::Scene(_)) => Err(BlobError::Header),
    }
}

fn counts(scene: &Scene<'_>) -> Counts {
    let rays = lookups(scene);
    let reflected: u64 = rays.iter().skip(1).sum();
    let primary = rays.first().copied().unwrap_or_default();
    let spheres = scene.spheres().len() as u64;
    Counts {
        primary_rays: primary,
        reflection_rays: reflected,
        triangle_tests: (primary + reflected) * spheres,
        ..Counts::default()
    }
}

/// What the rays of a pixel saw.
fn seen(scene: &Scene<'_>, pixel: [u16; 2]) -> Seen {
    let mut seen = Seen::default();
    scene.samples().for_each(|sample| see(scene, pixel, sample, &mut seen));
    seen
}

fn see(scene: &Scene<'_>, pixel: [u16; 2], sample: Sample, seen: &mut Seen) {
    let (mut place, mut ended) = (Place::camera(sample.number.into()), false);
    pixel::trace_telling(scene, pixel, sample, |met| {
        let sphere = &scene.spheres()[met.sphere];
        seen.surface(place, met.sphere as u32);
        let towards = |axis: usize| i64::from(met.point[axis] - sphere.centre[axis]) * i64::from(scene.light()[axis]);
        if towards(0) + towards(1) + towards(2) > 0 {
            seen.light(place, 0);
        }
        place = place.mirrored();
        ended = !met.is_seen;
    });
    if !ended {
        seen.surface(place, NONE);
    }
}

impl Engine for Planes12 {
    fn name(&self) -> &'static str {
        NAME
    }

    fn id(&self) -> u16 {
        KERNEL
    }

    fn grid_bits(&self) -> u32 {
        Words::default().widths.coordinate()
    }

    fn radius_min(&self) -> i32 {
        1
    }

    fn grid(&self, model: &Model, _: Option<u32>) -> Result<Grid, PrepareError> {
        Ok(Planes::new(model, &Words::default())?.place())
    }

    fn prepare(&self, model: &Model, _: &Options) -> Result<Prepared, PrepareError> {
        let planes = Planes::new(model, &Words::default())?;
        let scene = planes.scene().map_err(super::scene::PlanesError::from)?;
        let blob = blob::blob(&scene, &planes.place(), transfer(model.render.transfer));
        Ok(Prepared { blob, degenerates: Degenerates::default(), grid: planes.place() })
    }

    fn losses(&self, model: &Model, _: &Grid) -> Vec<String> {
        Planes::new(model, &Words::default()).map_or_else(|_| Vec::new(), |planes| planes.warnings)
    }

    fn inspect(&self, blob: &[u8]) -> Result<(Header, Sizes), BlobError> {
        let (scene, _) = opened(blob)?;
        let settings = scene.settings();
        let black = Radiance::default();
        let nothing = [0; 3];
        let header = Header {
            needs: Needs::NONE,
            size: settings.size,
            camera: CameraHeader {
                eye: nothing,
                along: nothing,
                first: [0; 3],
                right: [0; 3],
                down: [0; 3],
                fraction_bits: 0,
            },
            background: [black; 2],
            ambient: black,
            transfer: Transfer::Srgb,
            format: Format::Rgb888,
            samples: settings.samples,
            max_depth: 0,
            root: 0,
            depth: 0,
            counts: Records { spheres: scene.spheres().len() as u32, ..Records::default() },
            file_triangles: 0,
            file_spheres: scene.spheres().len() as u32,
            material_bits: 0,
            arithmetic: Arithmetic::default(),
            source: source(blob)?,
        };
        let spheres = size_of_val(scene.spheres()) as u64;
        Ok((header, Sizes { spheres, ..Sizes::default() }))
    }

    fn asked(&self, blob: &[u8]) -> Result<(Vec<Asked>, BTreeMap<u32, u32>), BlobError> {
        opened(blob).map(|_| (Vec::new(), BTreeMap::new()))
    }

    fn render(&self, blob: &[u8], _: [u16; 2], progress: Progress<'_>) -> Result<Rendered, BlobError> {
        let (scene, transfer) = opened(blob)?;
        let light = light(&scene, Way::Lanes(Lockstep::detected()), progress);
        Ok(Rendered { picture: picture(&scene, &light, transfer), counts: counts(&scene) })
    }

    fn witness(&self, blob: &[u8], tile: [u16; 2], progress: Progress<'_>) -> Result<(Rendered, Vec<Seen>), BlobError> {
        let (scene, _) = opened(blob)?;
        let [width, height] = scene.settings().size;
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let seen = pixels.map(|pixel| seen(&scene, pixel)).collect();
        Ok((self.render(blob, tile, progress)?, seen))
    }

    fn seconds(&self, blob: &[u8], _: [u16; 2]) -> Result<f64, BlobError> {
        let (scene, _) = opened(blob)?;
        let way = Way::Lanes(Lockstep::detected());
        let begin = Instant::now();
        black_box(light(&scene, way, &|_| ()));
        Ok(begin.elapsed().as_secs_f64())
    }

    fn tracer<'a>(&self, blob: &'a [u8]) -> Result<Box<dyn Trace + 'a>, BlobError> {
        let (scene, _) = opened(blob)?;
        let place = source_grid(&source(blob)?).ok_or(BlobError::Header)?;
        Ok(Box::new(Tracer::new(scene, place)))
    }

    fn stage<'a>(&self, blob: &'a [u8]) -> Result<Box<dyn Stage + 'a>, BlobError> {
        let (scene, transfer) = opened(blob)?;
        let place = source_grid(&source(blob)?).ok_or(BlobError::Header)?;
        Ok(Box::new(Staged::new(scene, place, transfer)))
    }
}

/// Where a blob's components lie in its scene.
fn source(blob: &[u8]) -> Result<SourceGrid, BlobError> {
    let header = planes_rt::blob::Header::of(blob).ok_or(BlobError::Header)?;
    Ok(SourceGrid { origin_bits: header.middle_bits, scale_bits: header.scale_bits })
}
