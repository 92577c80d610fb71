//! Which points a report is made of.
//!
//! The study of kernels has every kernel on every machine. The others vary one number each, of few kernels, at the smallest
//! of the sizes, so that all machines draw the same pictures: a point differs from the kernel's own in one thing alone.

use std::fmt::{self, Display, Formatter};

use clap::ValueEnum;

use super::row::{Machine, Point, Study, name};
use crate::engine::{ENGINES, Engine, PLANES12};

/// What is asked for. An empty list asks for all that there are.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    /// Few points, and small pictures.
    pub quick: bool,
    /// Names of kernels.
    pub kernels: Vec<String>,
    /// Machines.
    pub machines: Vec<Machine>,
    /// Studies.
    pub studies: Vec<Study>,
    /// Sizes of pictures, instead of those that follow from the scene.
    pub sizes: Vec<[u32; 2]>,
}

/// Whether something is among what is asked for; everything is where nothing is.
pub(super) fn asked<T: PartialEq>(list: &[T], value: &T) -> bool {
    list.is_empty() || list.contains(value)
}

/// As on the command line.
impl Display for Selection {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { quick, kernels, machines, studies, sizes } = self;
        let mut words = Vec::new();
        words.extend(quick.then(|| "--quick".to_owned()));
        words.extend(kernels.iter().map(|kernel| format!("--kernel {kernel}")));
        words.extend(machines.iter().map(|machine| format!("--machine {}", name(machine))));
        words.extend(studies.iter().map(|study| format!("--study {}", name(study))));
        words.extend(sizes.iter().map(|[width, height]| format!("--size {width}x{height}")));
        f.write_str(&words.join(" "))
    }
}

/// What a plan needs to know of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Traits {
    /// Its name.
    pub name: String,
    /// The size that it asks for, pixels.
    pub size: [u32; 2],
    /// The samples that it asks for.
    pub samples: u32,
    /// The depth that it asks for.
    pub depth: u32,
    /// Whether rays go on from surfaces, so that the depth matters.
    pub branches: bool,
    /// How many triangles it has.
    pub triangles: u32,
    /// Whether what samples see is random, so that the reference needs more of them.
    pub is_random: bool,
    /// How few its mesh can be decimated to; the same where it cannot be.
    pub fewest: u32,
}

/// Pictures of chips have at most so many pixels a side, unless a size is asked for.
const CHIP: [u32; 2] = [160, 128];

/// Pictures of the host, likewise.
const HOST: [u32; 2] = [640, 480];

/// Pictures of random samples, of which there may be a thousand a pixel, likewise.
const RANDOM: [u32; 2] = [80, 64];

/// Random samples a pixel of chips at most: with those of the built-in scene a picture would take QEMU an hour. How the error falls is
/// measured on the host, whose picture a chip's is, bit for bit.
const CHIP_SAMPLES: u32 = 4;

/// How many times the samples of a picture the reference has where they are random: its own noise is half the picture's.
const SURER: u32 = 4;

/// Samples a pixel by which a random picture's error is measured: each time four times as many, so that the error halves.
const RANDOM_SAMPLES: [u32; 6] = [1, 4, 16, 64, 256, 1024];

/// Kernels whose numbers are varied: the narrowest, the best, and what a user would do instead.
const STUDIED: [&str; 3] = ["exact14", "exact29", "f32"];

/// The points of a scene, in the order in which they are best measured: the host's first, since nothing else may run
/// beside them.
#[must_use]
pub fn points(scene: &Traits, selection: &Selection) -> Vec<Point> {
    let mut all: Vec<Point> =
        Machine::value_variants().iter().flat_map(|&machine| of_machine(scene, selection, machine)).collect();
    all.retain(|point| {
        asked(&selection.kernels, &point.kernel)
            && asked(&selection.machines, &point.machine)
            && asked(&selection.studies, &point.study)
    });
    all
}

/// A scene of random samples as it is measured in time: in small pictures, and of few samples on a chip. Rows say both.
fn in_time(scene: &Traits, selection: &Selection, machine: Machine) -> Traits {
    let (mut scene, on_chip) = (scene.clone(), machine != Machine::Host);
    if scene.is_random && (on_chip || selection.quick) {
        scene.size = bounded(scene.size, RANDOM);
    }
    if scene.is_random && on_chip {
        scene.samples = scene.samples.min(CHIP_SAMPLES);
    }
    scene
}

/// All points of a machine.
fn of_machine(scene: &Traits, selection: &Selection, machine: Machine) -> Vec<Point> {
    let scene = &in_time(scene, selection, machine);
    let small = bounded(scene.size, CHIP);
    let sizes = match (&selection.sizes[..], machine) {
        ([], Machine::Host) if !selection.quick => vec![bounded(scene.size, HOST), small],
        ([], _) => vec![small],
        (sizes, _) => sizes.to_vec(),
    };
    let mut all = Vec::new();
    for (place, &size) in sizes.iter().enumerate() {
        if sizes[..place].contains(&size) {
            continue;
        }
        all.extend(kernels(scene).map(|engine| point(scene, Study::Kernels, engine.name(), machine, size)));
    }
    let size = sizes.into_iter().min_by_key(|&[width, height]| u64::from(width) * u64::from(height)).unwrap_or(small);
    let of = |study, kernel: &str| point(scene, study, kernel, machine, size);
    if scene.is_random && machine == Machine::Host {
        let size = if selection.sizes.is_empty() { bounded(scene.size, RANDOM) } else { size };
        all.extend(random_samples(scene, selection.quick, machine, size));
    }
    for kernel in ["hanika-c", "hanika-cd"] {
        all.extend(arithmetic(selection.quick, &of, kernel));
    }
    for kernel in STUDIED {
        all.extend(numbers(scene, selection.quick, &of, kernel));
    }
    // On chips, what one firmware draws, and in time: the wide words of exact29 are slow on a Cortex-M0.
    all.retain(|point| match machine {
        Machine::Host => true,
        Machine::Rv32imac => is_common(point) || point.kernel == "exact29" && !selection.quick,
        Machine::Thumbv6m => is_common(point),
    });
    all
}

/// Those that a scene is for: that of 1994 has spheres alone.
fn kernels(scene: &Traits) -> impl Iterator<Item = &'static dyn Engine> {
    ENGINES.into_iter().chain((scene.triangles == 0).then_some(PLANES12))
}

/// Whether a point is measured on every machine.
fn is_common(point: &Point) -> bool {
    point.study == Study::Kernels || point.kernel == "exact14" && point.study != Study::Samples
}

/// The scene by a kernel as it comes.
fn point(scene: &Traits, study: Study, kernel: &str, machine: Machine, size: [u32; 2]) -> Point {
    Point {
        scene: scene.name.clone(),
        study,
        kernel: kernel.into(),
        machine,
        size,
        samples: scene.samples,
        depth: scene.depth,
        leaf: None,
        grid_bits: None,
        triangles: None,
        knobs: [None; 3],
        reference_samples: scene.is_random.then(|| SURER * scene.samples),
    }
}

/// Random samples, by every kernel: how fast the noise falls, and what is left of the kernel's own error. All are compared with
/// the one picture that the reference has the most samples for.
fn random_samples(scene: &Traits, quick: bool, machine: Machine, size: [u32; 2]) -> Vec<Point> {
    let counts = if quick { &RANDOM_SAMPLES[..4] } else { &RANDOM_SAMPLES };
    let most = counts.iter().copied().max().unwrap_or(1);
    let of = |kernel: &str, samples| Point {
        samples,
        reference_samples: Some(SURER * most),
        ..point(scene, Study::Samples, kernel, machine, size)
    };
    kernels(scene).flat_map(|engine| counts.iter().map(move |&samples| of(engine.name(), samples))).collect()
}

/// C, D and E, of the kernels that have them.
fn arithmetic(quick: bool, of: &impl Fn(Study, &str) -> Point, kernel: &str) -> Vec<Point> {
    let set = |study, place: usize, values: &[u8]| {
        let with = |&value: &u8| {
            let mut point = of(study, kernel);
            point.knobs[place] = Some(value);
            point
        };
        values.iter().map(with).collect::<Vec<_>>()
    };
    match (kernel, quick) {
        ("hanika-c", true) => set(Study::C, 0, &[6, 12, 18]),
        ("hanika-c", false) => set(Study::C, 0, &[0, 4, 8, 10, 12, 14, 16, 20, 24, 28]),
        (_, true) => Vec::new(),
        // D lies within 6 of C, which is 15; E above what the scene allows clamps.
        (_, false) => {
            [set(Study::D, 1, &[9, 10, 11, 12, 13, 14, 15]), set(Study::E, 2, &[0, 4, 8, 12, 16, 20, 24, 28])].concat()
        }
    }
}

/// What every kernel has.
fn numbers(scene: &Traits, quick: bool, of: &impl Fn(Study, &str) -> Point, kernel: &str) -> Vec<Point> {
    let mut all = Vec::new();
    let mut add = |study, values: &[u32], set: fn(&mut Point, u32)| {
        for &value in values {
            let mut point = of(study, kernel);
            set(&mut point, value);
            all.push(point);
        }
    };
    let few = |values: &[u32]| if quick { values.iter().copied().step_by(3).collect() } else { values.to_vec() };
    if quick && kernel != "exact14" {
        return all;
    }
    add(Study::Leaf, &few(&[1, 2, 4, 8, 16, 32, 64]), |point, leaf| point.leaf = Some(leaf));
    if !scene.is_random {
        add(Study::Samples, &few(&[1, 2, 4, 8, 16]), |point, samples| point.samples = samples);
    }
    if scene.branches {
        add(Study::Depth, &few(&[0, 1, 2, 3, 4, 6, 8, 10]), |point, depth| point.depth = depth);
    }
    // The grid as it comes is the series' end.
    let bits: &[u32] = match kernel {
        "exact14" => &[8, 10, 12, 13, 14],
        "exact29" => &[8, 11, 14, 17, 20, 23, 26],
        _ => &[],
    };
    add(Study::Grid, &few(bits), |point, bits| point.grid_bits = Some(bits));
    let quarters: &[u32] = if quick { &[2, 4] } else { &[2, 3, 4] };
    // The whole mesh is the series' end.
    let decimated: Vec<u32> = targets(scene);
    if !bits.is_empty() {
        all.push(of(Study::Grid, kernel));
    }
    for width in quarters.iter().map(|quarter| quarter * scene.size[0].min(CHIP[0]) / 4) {
        let [w, h] = scene.size;
        let height = (u64::from(h) * u64::from(width) / u64::from(w).max(1)).max(1) as u32;
        all.push(Point { size: [width.max(1), height], ..of(Study::Size, kernel) });
    }
    let targets: Vec<u32> = if quick { decimated.into_iter().step_by(2).collect() } else { decimated };
    all.extend(targets.iter().map(|&target| Point { triangles: Some(target), ..of(Study::Triangles, kernel) }));
    if !targets.is_empty() {
        all.push(of(Study::Triangles, kernel));
    }
    all
}

/// How many triangles a mesh is decimated to: 100, 300, 1000 and so on, and the fewest where that is more than the first.
fn targets(scene: &Traits) -> Vec<u32> {
    let steps = (2..9).flat_map(|power| [10u32.pow(power), 3 * 10u32.pow(power)]);
    let mut targets: Vec<u32> =
        steps.map(|step| step.max(scene.fewest)).take_while(|&step| step < scene.triangles).collect();
    targets.dedup();
    targets
}

/// A size in the same proportion, no side of which is longer than in `most`; the same where none is.
#[must_use]
pub fn bounded(size: [u32; 2], most: [u32; 2]) -> [u32; 2] {
    let [[width, height], [wide, high]] = [size, most].map(|size| size.map(|side| u64::from(side.max(1))));
    // The tighter of two ratios; no rounding goes beyond `most`.
    let (over, under) = if wide * height <= high * width { (wide, width) } else { (high, height) };
    if over >= under {
        return size;
    }
    [width, height].map(|side| (side * over / under).max(1) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Traits {
        Traits {
            name: "a".into(),
            size: [640, 480],
            samples: 1,
            depth: 10,
            branches: true,
            triangles: 1570,
            fewest: 120,
            is_random: false,
        }
    }

    #[test]
    fn sizes_keep_their_proportions() {
        assert_eq!(bounded([640, 480], [160, 128]), [160, 120]);
        assert_eq!(bounded([512, 512], [160, 128]), [128, 128]);
        assert_eq!(bounded([100, 90], [160, 128]), [100, 90]);
        assert_eq!(bounded([16384, 1], [160, 128]), [160, 1]);
        assert_eq!(bounded([1, 16384], [160, 128]), [1, 128]);
    }

    #[test]
    fn no_point_is_there_twice_and_each_varies_one_thing() {
        for quick in [false, true] {
            let all = points(&scene(), &Selection { quick, ..Selection::default() });
            let distinct: std::collections::BTreeSet<_> = all.iter().collect();
            assert_eq!(distinct.len(), all.len());
            let plain = |point: &&Point| point.study == Study::Kernels;
            assert_eq!(all.iter().filter(plain).count(), if quick { 24 } else { 32 });
            for point in &all {
                let varied = [
                    point.leaf.is_some(),
                    point.grid_bits.is_some(),
                    point.triangles.is_some(),
                    point.knobs != [None; 3],
                ];
                assert!(varied.into_iter().filter(|&is_varied| is_varied).count() <= 1, "{point:?}");
            }
        }
    }

    #[test]
    fn a_selection_selects() {
        let selection = Selection {
            kernels: vec!["exact14".into()],
            machines: vec![Machine::Thumbv6m],
            studies: vec![Study::Leaf],
            sizes: vec![[32, 24], [64, 48]],
            ..Selection::default()
        };
        let all = points(&scene(), &selection);
        assert_eq!(all.len(), 7);
        assert!(all.iter().all(|point| {
            (point.kernel.as_str(), point.machine, point.size) == ("exact14", Machine::Thumbv6m, [32, 24])
        }));
    }

    #[test]
    fn meshes_are_decimated_as_far_as_they_can_be() {
        assert_eq!(targets(&scene()), [120, 300, 1000]);
        assert_eq!(targets(&Traits { fewest: 1, ..scene() }), [100, 300, 1000]);
        assert_eq!(targets(&Traits { fewest: 1570, ..scene() }), [0; 0]);
    }

    #[test]
    fn random_samples_are_compared_with_one_picture_of_many() {
        let random = Traits { is_random: true, samples: 16, ..scene() };
        for (quick, counts) in [(true, 4), (false, 6)] {
            let all = points(&random, &Selection { quick, studies: vec![Study::Samples], ..Selection::default() });
            assert_eq!(all.len(), ENGINES.len() * counts);
            let most = all.iter().map(|point| point.samples).max();
            assert!(all.iter().all(|point| point.machine == Machine::Host && point.size == [80, 60]));
            assert!(all.iter().all(|point| point.reference_samples == most.map(|most| SURER * most)));
        }
        let kernels = Selection { studies: vec![Study::Kernels], ..Selection::default() };
        for point in points(&random, &kernels) {
            // A chip would take hours for the host's.
            let on_host = point.machine == Machine::Host;
            let [samples, most] = if on_host { [16, 640] } else { [4, 80] };
            assert_eq!((point.samples, point.reference_samples), (samples, Some(SURER * samples)), "{point}");
            assert!(point.size[0] <= most, "{point}");
        }
        let asked = Selection { sizes: vec![[320, 240]], ..kernels.clone() };
        assert!(points(&random, &asked).iter().all(|point| point.size == [320, 240]));
        let quick = Selection { quick: true, ..Selection::default() };
        assert!(points(&random, &quick).iter().all(|point| point.size[0] <= 80));
        assert!(points(&scene(), &Selection::default()).iter().all(|point| point.reference_samples.is_none()));
    }

    #[test]
    fn the_tracer_of_spheres_is_asked_for_spheres_alone() {
        let of = |triangles, is_random| {
            let scene = Traits { triangles, is_random, samples: 4, fewest: triangles, ..scene() };
            let all = points(&scene, &Selection::default());
            let mine = all.into_iter().filter(|point| point.kernel == PLANES12.name());
            mine.map(|point| point.study).collect::<std::collections::BTreeSet<_>>()
        };
        assert_eq!(of(1, true), [].into());
        assert_eq!(of(0, false), [Study::Kernels].into());
        assert_eq!(of(0, true), [Study::Kernels, Study::Samples].into());
    }

    #[test]
    fn depths_are_for_scenes_where_rays_go_on() {
        let depths = |branches| {
            let all = points(&Traits { branches, ..scene() }, &Selection::default());
            all.iter().filter(|point| point.study == Study::Depth).count()
        };
        assert_eq!(depths(false), 0);
        assert!(depths(true) > 0);
    }
}
