//! The machine of 1994, modelled: what had to be swapped, how fast it is, and what the next one's memory would have changed.

use std::fmt::Write as _;
use std::path::Path;

use host_tools::import;
use host_tools::pixel_planes::memory::Store;
use host_tools::pixel_planes::plot;
use host_tools::pixel_planes::program::{Operation, Shape, Value};
use host_tools::pixel_planes::{Machine as Modelled, Run};
use host_tools::planes::scene::{Options, Planes};

use super::text::table;

/// Of the picture that frames a second are of.
const FULL: [u32; 2] = [1280, 1024];
const RENDERERS: u32 = 32;
/// The text's memory, and that of the machine that it looks forward to: 256 bytes a pixel.
const BUDGETS: [u32; 2] = [208, 2048];

/// All figures.
#[derive(Clone, Debug)]
pub(crate) struct Machine {
    shape: Shape,
    /// By memory.
    runs: Vec<(Modelled, Run)>,
    /// Of all lanes, the share that was enabled at each step.
    enabled: Vec<f64>,
}

impl Machine {
    /// Runs the project's scene of spheres in a picture of a size.
    pub(crate) fn measure(size: [u16; 2]) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/planes/scene.toml");
        let mut model = import::load(&path).expect("one of the project's scenes").model;
        model.render.size = size.map(u32::from);
        let options = Options::default();
        let planes = Planes::new(&model, &options).expect("spheres alone");
        let scene = planes.scene().expect("in range, since it was made");
        let settings = scene.settings();
        let shape = Shape {
            widths: settings.widths,
            spheres: scene.spheres().len() as u32,
            generations: settings.generations.into(),
            outline: settings.outline,
        };
        let runs = BUDGETS.map(|local_bits| {
            let machine = Modelled { store: Store { local_bits, ..Store::default() }, ..Modelled::default() };
            let run = Run::new(&machine, &shape).expect("the text's program fits");
            (machine, run)
        });
        let drawn = runs[0].1.draw(&scene, &shape, &|_| ());
        let pixels = f64::from(size[0]) * f64::from(size[1]);
        let enabled = drawn.enabled.iter().map(|&count| count as f64 / pixels).collect();
        Self { shape, runs: runs.into(), enabled }
    }

    /// Frames a second against renderers, spheres and generations, and enabled lanes over time.
    pub(crate) fn plot(&self) -> String {
        let (machine, run) = &self.runs[0];
        plot::svg(machine, &self.shape, run, (FULL, RENDERERS), &self.enabled)
            .expect("a string takes whatever is drawn")
    }

    /// The part of the document.
    pub(crate) fn document(&self) -> String {
        let (machine, run) = &self.runs[0];
        let fullest = run.plan.fullest().expect("there are steps");
        let held: Vec<String> = fullest.held().map(|value| format!("{value:?}")).collect();
        let mut text = format!(
            "\n## The machine\n\n\
             `intray pixel-planes scenes/planes/scene.toml` models the renderers: {} spheres, {} generations, every value in bits of \
             its own, every operation a bit at a time; `--steps` has where each value lies at each step. The picture is the \
             kernel's, bit for bit, and so is every value on the way (`tests/tests/planes/machine.rs`). Not in the text, and \
             arguments: {:.0} MHz, {} cycle for an operation on a bit, {} for a block of 32 bits to the store or back. A processor \
             has a carry and an enable register beside its memory, takes bits from any places, and is given its camera ray by the \
             tree that works out what is linear in a pixel's place.\n\n\
             At most {} of {} bits are in use, in `{}`, by {} and what that needs in between. Swapped out, with {} of {} bits of \
             the store:\n\n",
            self.shape.spheres,
            self.shape.generations,
            machine.clock_hz / 1e6,
            machine.cycles_per_bit,
            machine.store.block_cycles,
            fullest.bits,
            machine.store.local_bits,
            fullest.step,
            held.join(", "),
            run.plan.backing_bits,
            machine.store.backing_bits,
        );
        let swapped = run.plan.swapped.iter().map(|(&value, &[out, back])| {
            vec![format!("{value:?}"), self.shape.bits(value).to_string(), out.to_string(), back.to_string()]
        });
        text += &table(&["value", "bits", "times out", "times back"], swapped);
        let looking = run.steps.iter().zip(&self.enabled).filter(|(step, _)| step.operation == Operation::Begin);
        let looking: Vec<String> = looking.map(|(_, share)| format!("{:.0} %", 100.0 * share)).collect();
        // A string takes text.
        let _ = write!(
            text,
            "Lanes that look for a sphere, generation by generation: {}. The others wait, since all take the same steps.\n\n\
             ![Frames a second, and enabled lanes](studies/planes-machine.svg)\n\n\
             Frames a second are of {}x{} pixels by {RENDERERS} renderers where nothing else is said.\n\n\
             ## 256 bytes a pixel\n\n\
             The text hopes for the next machine's 256 bytes a pixel, for shadows, highlights and transparency. The same program \
             with that memory:\n\n",
            looking.join(", "),
            FULL[0],
            FULL[1],
        );
        let rows = self.runs.iter().map(|(machine, run)| {
            let most = run.plan.fullest().map_or(0, |moment| moment.bits);
            let waiting = 100.0 * run.waiting as f64 / (run.computing + run.waiting) as f64;
            vec![
                machine.store.local_bits.to_string(),
                most.to_string(),
                run.plan.swapped.len().to_string(),
                format!("{waiting:.1} %"),
                format!("{:.2}", run.frames_a_second(FULL, RENDERERS)),
            ]
        });
        text += &table(&["bits", "most in use", "values swapped", "waiting", "frames a second"], rows);
        let free = self.runs[1].0.store.local_bits - self.runs[1].1.plan.fullest().map_or(0, |moment| moment.bits);
        let of = |values: &[Value]| values.iter().map(|&value| self.shape.bits(value)).sum::<u32>();
        let ray = of(&[Value::Origin, Value::Direction, Value::Share]);
        let _ = writeln!(
            text,
            "{free} bits are left. A shadow takes a mask of 1 bit and the words of an intersection, which are free by then: the \
             light's direction is sent with the instructions. A highlight takes another cosine, {} bits. A ray through a surface \
             that waits until the reflected one is done takes {ray} bits with its share of the light: there is room for {} of \
             them, and so for transparency to that depth. In 208 bits there is room for none.",
            of(&[Value::Cosine]),
            free / ray,
        );
        text
    }
}
