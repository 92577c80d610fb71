//! A firmware holds nothing superfluous: how large rendering code is, and that no routine is linked for which nothing asks,
//! whatever was inlined into what. A program that has more than a profile asks for must be found out.
//!
//! Boards for which the compiler's library is absent are skipped, with a line that says so.

use core_rt::profile::{Need, Needs, Prefer};
use firmware_rt::board::{BOARDS, Board, MICROBIT};
use host_tools::emulate::elf::Elf;
use host_tools::emulate::firmware;
use host_tools::emulate::probe::{DRAWING, Probe, SMALLEST, WHITTED, WHOLE, without};
use host_tools::emulate::routines::{routines, superfluous};
use tests::symbols::{Category, Found, find};

/// The boards that can be built for here, one a target: what is looked at knows no more of a board.
fn boards() -> impl Iterator<Item = &'static Board> {
    let mut targets = Vec::new();
    BOARDS.into_iter().filter(move |board| {
        if targets.contains(&board.target) {
            return false;
        }
        targets.push(board.target);
        let checked = firmware::check_board(board);
        if let Err(error) = &checked {
            println!("skipped {}: {error}", board.name);
        }
        checked.is_ok()
    })
}

fn probe(board: &'static Board, program: &'static str, prefer: Prefer, needs: Needs) -> Probe<'static> {
    Probe { board, program, prefer, blob: None, needs: Some(needs) }
}

fn built(board: &'static Board, program: &'static str, prefer: Prefer, needs: Needs) -> Elf {
    probe(board, program, prefer, needs).provide().expect("it can be built")
}

/// Bytes of code and constants for rendering alone, where size is preferred: what a Cortex-M0 may have.
const MOST: [(&str, Needs, u64); 2] = [("the smallest", SMALLEST, 6 << 10), ("Whitted's", WHITTED, 24 << 10)];

#[test]
fn profiles_are_as_small_as_is_promised() {
    for board in boards() {
        for (name, needs, most) in MOST {
            let size = |program| probe(board, program, Prefer::Size, needs).size().expect("it can be built");
            let (drawing, whole) = (size(DRAWING), size(WHOLE));
            println!("{}: {name} profile takes {drawing} bytes, with the blob's check {whole}", board.name);
            assert!(board != &MICROBIT || drawing <= most, "{name}: {drawing} > {most}");
        }
    }
}

fn with(needs: &[Need]) -> Needs {
    needs.iter().fold(SMALLEST, |all, &need| all.with(need, true))
}

/// What is looked at: nothing, one thing each, and all of it.
fn profiles() -> [(&'static str, Needs); 14] {
    use Need::{
        Bilinear, BlinnPhong, Bounces, Checker, DirectionalLight, Falloff, Gray8, Linear, Orthographic, Paths,
        PointLight, Reflection, Refraction, Rgb888, Roughness, Schlick, Shadows, Sky, SmoothNormals, Spheres, Srgb,
        Supersampling, Texture,
    };
    let other_output = SMALLEST.without(Linear).without(Rgb888).with(Srgb, true).with(Gray8, true);
    [
        ("smallest", SMALLEST),
        ("shadows", with(&[Shadows])),
        ("sun", SMALLEST.without(PointLight).with(DirectionalLight, true).with(Shadows, true)),
        ("smooth", with(&[SmoothNormals, Shadows])),
        ("mirror", with(&[Reflection, Bounces])),
        ("one look", with(&[Reflection, Sky])),
        ("glass", with(&[Spheres, Reflection, Refraction, Bounces, Schlick])),
        ("painted", with(&[Texture, Bilinear, Checker])),
        ("shiny", with(&[BlinnPhong, Falloff])),
        ("other output", other_output.with(Orthographic, true).with(Supersampling, true)),
        ("Whitted", WHITTED),
        ("paths", with(&[Paths])),
        ("rough", with(&[Reflection, Bounces, Roughness])),
        ("paths of all kinds", WHITTED.with(Paths, true).with(Roughness, true)),
    ]
}

#[test]
fn nothing_is_linked_for_which_nothing_asks() {
    for board in boards() {
        for prefer in [Prefer::Speed, Prefer::Size] {
            for (name, needs) in profiles() {
                let elf = built(board, WHOLE, prefer, needs);
                let of = format!("{} {prefer:?} {name}", board.name);
                assert_eq!(find(elf.bytes()).expect("it has symbols"), Found::new(), "{of}");
                let found = routines(elf.bytes()).expect("it has debug information");
                assert!(superfluous(&found, needs).is_empty(), "{of}: {:?}", superfluous(&found, needs));
            }
        }
    }
}

/// The needs that have no routine of their own.
const BRANCHES: [Need; 16] = [
    Need::PointLight,
    Need::DirectionalLight,
    Need::Emission,
    Need::Ambient,
    Need::Linear,
    Need::WideIds,
    Need::WideNormals,
    Need::WideUvs,
    Need::Rgb888,
    Need::SeveralLights,
    Need::Bounces,
    Need::WholeTriangles,
    Need::Ids,
    Need::IdsInRecords,
    // Each has what the other one has, and something of its own, or not.
    Need::Phong,
    Need::Reflection,
];

#[test]
fn what_nothing_asks_for_is_found() {
    for board in boards() {
        // All of them: there is one projection, one transfer and one format in each program.
        let others = WHITTED.without(Need::Srgb).without(Need::Rgb888).with(Need::Linear, true);
        let others = others.with(Need::Orthographic, true).with(Need::SharedVertices, true);
        let [paths, rough] = [Need::Paths, Need::Roughness].map(|need| WHITTED.with(need, true));
        let programs = [WHITTED, others.with(Need::Rgb565, true), others.with(Need::Gray8, true), paths, rough];
        let programs = programs.map(|needs| {
            (needs, { routines(built(board, WHOLE, Prefer::Speed, needs).bytes()).expect("it has debug information") })
        });
        for need in Need::ALL.into_iter().filter(|need| !BRANCHES.contains(need)) {
            let is_found = |(needs, found): &(Needs, Vec<_>)| {
                needs.has(need) && !superfluous(found, without(*needs, need)).is_empty()
            };
            assert!(programs.iter().any(is_found), "{}: {need} leaves no trace", board.name);
        }
    }
}

#[test]
fn a_wide_division_is_found() {
    for board in boards() {
        let elf = Probe { board, program: "leaks-division", prefer: Prefer::Size, blob: None, needs: None }.provide();
        let found = find(elf.expect("it can be built").bytes()).expect("it has symbols");
        assert_eq!(found.keys().copied().collect::<Vec<_>>(), [Category::WideDivision], "{}: {found:?}", board.name);
    }
}
