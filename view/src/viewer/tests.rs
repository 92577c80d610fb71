use super::*;
use crate::canvas::order;
use crate::overlay::HELP;
use crate::pad::Pad;
use crate::painter::Drawn;
use glam::DVec3;
use host_tools::model::{Camera, Sphere};

fn model() -> Model {
    Model { spheres: vec![Sphere { centre: DVec3::ZERO, radius: 0.5, material: 0 }], ..Model::default() }
}

fn viewer() -> Viewer {
    let setup = Setup { kernels: [0, 2], size: [64, 48], board: 0, panel: [20, 10], is_chip: false };
    Viewer::new(&model(), setup)
}

fn wish(order: Option<Order>) -> Wish {
    match order {
        Some(Order::Draw(wish)) => wish,
        other => panic!("{other:?}"),
    }
}

/// The draft that was asked for, in one colour.
fn draft(wish: Wish, grey: u8) -> Update {
    let [width, height] = wish.draft.unwrap();
    Update::Drawn(wish.serial, Drawn::Draft(Picture::from_fn(width, height, |_, _| [grey; 3]), Took::default()))
}

/// The full picture that was asked for, in one colour.
fn full(viewer: &mut Viewer, wish: Wish, grey: u8, now: f64) -> Vec<Order> {
    assert_eq!(wish.draft, None);
    for tile in order(wish.view.size.map(|side| side as u16)) {
        let pixels = vec![[grey; 3]; tile.pixels()];
        assert!(viewer.update(Update::Drawn(wish.serial, Drawn::Tiles(vec![(tile, pixels)])), now).is_empty());
    }
    viewer.update(Update::Drawn(wish.serial, Drawn::Full(Took { seconds: 0.1, rays: 100 })), now)
}

fn painted(viewer: &Viewer) -> Vec<u32> {
    let [width, height] = viewer.setup.size;
    let mut pixels = vec![0; (width * height) as usize];
    viewer.paint(&mut Frame::new(&mut pixels, [width, height]).unwrap());
    pixels
}

#[test]
fn a_camera_at_rest_is_drawn_in_full_once_and_judged() {
    let mut viewer = viewer();
    let first = wish(viewer.tick(0.0));
    assert_eq!((first.view.camera, first.view.size, first.draft), (Camera::default(), [64, 48], None));
    assert!(viewer.tick(1.0).is_none() && viewer.full().is_none());
    let orders = full(&mut viewer, first, 7, 2.0);
    assert!(matches!(&orders[..], [Order::Judge(case)] if case.serial == 1 && Some(&case.picture) == viewer.full()));
    assert_eq!(viewer.full_after(), Some(2.0));
    assert!(viewer.tick(3.0).is_none() && viewer.deadline(3.0).is_none());
}

#[test]
fn moving_is_drawn_in_drafts_one_at_a_time_and_then_in_full() {
    let mut viewer = viewer();
    let first = wish(viewer.tick(0.0));
    full(&mut viewer, first, 7, 0.5);
    viewer.hold(Hold::Ahead, true, 1.0);
    let moved = wish(viewer.tick(1.05));
    assert_eq!(moved.draft, Some([32, 24]));
    assert!(moved.view.camera.position.z < 1.0);
    // It goes on while that is drawn, and nothing is asked for meanwhile.
    assert!(viewer.tick(1.1).is_none());
    viewer.update(draft(moved, 9), 1.12);
    assert_eq!((viewer.canvas.picture().pixels()[0], viewer.full()), ([9; 3], None));
    let next = wish(viewer.tick(1.12));
    assert!(next.view.camera.position.z < moved.view.camera.position.z);
    // Where one stops while a draft is drawn, that is not waited for, and not seen any more.
    viewer.hold(Hold::Ahead, false, 1.15);
    let rest = wish(viewer.tick(1.15));
    assert_eq!((rest.draft, rest.view.camera), (None, viewer.walk.camera()));
    viewer.update(draft(next, 200), 1.2);
    assert_eq!(viewer.canvas.picture().pixels()[0], [9; 3]);
    let orders = full(&mut viewer, rest, 50, 1.4);
    assert!(matches!(orders[..], [Order::Judge(_)]));
    assert!((viewer.full_after().unwrap() - 0.25).abs() < 1e-9);
    assert_eq!(viewer.drafts(), 1);
}

#[test]
fn a_mouse_that_rests_is_waited_for() {
    let mut viewer = viewer();
    viewer.tick(0.0);
    viewer.drag([10.0, -5.0], 1.0);
    let turned = wish(viewer.tick(1.0));
    assert!(turned.draft.is_some() && turned.view.camera != Camera::default());
    viewer.update(draft(turned, 1), 1.01);
    assert!(viewer.tick(1.02).is_none());
    let deadline = viewer.deadline(1.02).unwrap();
    assert!((1.05..1.2).contains(&deadline));
    assert_eq!(wish(viewer.tick(deadline)).draft, None);
    viewer.zoom(1.0, 2.0);
    assert!(wish(viewer.tick(2.0)).draft.is_some());
}

#[test]
fn kernels_are_switched_and_what_comes_late_is_not_seen() {
    let mut viewer = viewer();
    let first = wish(viewer.tick(0.0));
    viewer.act(Action::Kernel(3), 1.0);
    viewer.act(Action::Kernel(99), 1.0);
    let second = wish(viewer.tick(1.0));
    assert_eq!((second.view.kernel, second.draft, viewer.kernel()), (3, None, KERNELS[3].name()));
    assert!(full(&mut viewer, first, 255, 1.5).is_empty());
    assert!(viewer.full().is_none());
    full(&mut viewer, second, 3, 2.0);
    assert!(painted(&viewer).ends_with(&[0x03_0303]));
}

#[test]
fn a_picture_is_saved_when_it_is_full() {
    let mut viewer = viewer();
    assert!(viewer.act(Action::Save, 0.0).is_empty());
    let first = wish(viewer.tick(0.0));
    let orders = full(&mut viewer, first, 7, 1.0);
    assert!(matches!(orders[..], [Order::Judge(_), Order::Save(_, "exact29")]), "{orders:?}");
    assert!(matches!(viewer.act(Action::Save, 2.0)[..], [Order::Save(..)]));
    assert!(matches!(viewer.act(Action::Quit, 2.0)[..], [Order::Quit]));
}

#[test]
fn the_camera_that_is_written_is_the_one_that_is_seen() {
    let mut viewer = viewer();
    viewer.hold(Hold::Right, true, 1.0);
    viewer.hold(Hold::Right, false, 1.05);
    let seen = wish(viewer.tick(1.05)).view.camera;
    let orders = viewer.act(Action::WriteCamera, 1.1);
    assert!(matches!(orders[..], [Order::WriteCamera(camera)] if camera == seen && seen != Camera::default()));
    viewer.act(Action::Home, 1.2);
    assert_eq!(wish(viewer.tick(1.2)).view.camera, Camera::default());
}

#[test]
fn a_window_of_any_size_goes_on() {
    let mut viewer = viewer();
    for size in [[0, 0], [0, 5], [1, 1], [70_000, 3], [3, 2]] {
        viewer.resize(size, 1.0);
        let order = viewer.tick(1.0);
        assert_eq!(order.is_some(), size[0] > 0 && size[0] < 70_000, "{size:?}");
        viewer.hold(Hold::Ahead, true, 1.0);
        viewer.tick(1.1);
        viewer.hold(Hold::Ahead, false, 1.2);
        if let Some(Order::Draw(wish)) = viewer.tick(1.2) {
            full(&mut viewer, wish, 5, 1.3);
        }
        painted(&viewer);
    }
}

#[test]
fn a_panel_is_shown_as_large_as_it_fits_and_timed() {
    let mut viewer = viewer();
    viewer.act(Action::Overlay, 0.0);
    viewer.act(Action::Overlay, 0.0);
    viewer.act(Action::Chip, 0.0);
    let panel = wish(viewer.tick(0.0));
    assert_eq!((panel.view.size, panel.view.kernel, panel.view.format), ([20, 10], 2, Format::Rgb565));
    let orders = full(&mut viewer, panel, 255, 1.0);
    assert!(matches!(&orders[..], [Order::Judge(_), Order::Time(job)] if job.target == 0), "{orders:?}");
    // Three times as large: 60 of 64 columns, 30 of 48 rows.
    let white = painted(&viewer).iter().filter(|&&pixel| pixel == 0xff_ff_ff).count();
    assert_eq!(white, 60 * 30);
    let effort = Effort { instructions: 5, cycles: 7, seconds: 2.0, blob_bytes: 9, is_same: true };
    viewer.update(Update::Timed(panel.serial, Ok(effort)), 1.5);
    viewer.act(Action::Overlay, 1.5);
    let lines = viewer.lines().join("\n");
    assert!(lines.contains("microbit (nRF51822, Cortex-M0) at 16 MHz: 2.00 s a frame"), "{lines}");
    assert!(lines.contains("bit for bit"), "{lines}");
    // Another view is guessed by its rays: as many, as long.
    viewer.hold(Hold::Ahead, true, 2.0);
    let draft_wish = wish(viewer.tick(2.05));
    assert_eq!(draft_wish.draft, Some([20, 10]));
    let lines = viewer.lines().join("\n");
    assert!(lines.contains("about 2.0 s a frame, by the rays of the last count"), "{lines}");
    assert!(matches!(viewer.act(Action::Board, 2.1)[..], []), "nothing is full");
    assert!(viewer.lines().join("\n").contains("hifive1"));
}

#[test]
fn what_is_written_says_what_it_is() {
    let mut viewer = viewer();
    let first = wish(viewer.tick(0.0));
    full(&mut viewer, first, 7, 1.0);
    assert_eq!(viewer.lines(), ["exact29 64x48: 100 ms, full 1000 ms after stopping", "error: being worked out"]);
    let black = Picture::new(4, 4);
    let comparison = host_tools::compare::compare(&black, &Picture::from_fn(4, 4, |_, _| [1, 1, 0])).unwrap();
    viewer.update(Update::Judged(first.serial + 1, Box::new(comparison)), 1.0);
    assert_eq!(viewer.lines()[1], "error: being worked out", "of another picture");
    viewer.update(Update::Judged(first.serial, Box::new(comparison)), 1.0);
    assert_eq!(viewer.lines()[1], "error against f64: PSNR 49.9 dB, 16 pixels over 1, 0 over 64");
    viewer.update(Update::Said("done".into()), 1.0);
    viewer.act(Action::Overlay, 1.0);
    viewer.update(Update::Said("done".into()), 1.0);
    let lines = viewer.lines();
    assert_eq!((lines[2].as_str(), lines.len()), ("done", 3 + HELP.len()));
    viewer.act(Action::Overlay, 1.0);
    assert_eq!(viewer.lines(), [""; 0]);
    viewer.act(Action::Kernel(1), 2.0);
    let second = wish(viewer.tick(2.0));
    viewer.update(Update::Drawn(second.serial, Drawn::Failed("no".into())), 2.0);
    viewer.act(Action::Overlay, 2.0);
    assert!(viewer.lines().contains(&"no".into()));
}

#[test]
fn a_pad_steers_and_rests() {
    let mut viewer = viewer();
    viewer.tick(0.0);
    viewer.update(Update::Pad(Pad { left: [0.0, -1.0], has_right: true, ..Pad::default() }), 1.0);
    let moved = wish(viewer.tick(1.05));
    assert!(moved.draft.is_some() && moved.view.camera.position.z < 1.0);
    viewer.update(Update::Pad(Pad::default()), 1.1);
    assert_eq!(wish(viewer.tick(1.1)).draft, None);
    viewer.hold(Hold::Left, true, 1.2);
    viewer.let_go(1.25);
    assert!(viewer.steer().is_still());
}

#[test]
fn samples_that_are_to_be_more_are_seen_and_are_not_the_full_picture() {
    let mut viewer = viewer();
    let first = wish(viewer.tick(0.0));
    let tiles = |grey| order([64, 48]).into_iter().map(|tile| (tile, vec![[grey; 3]; tile.pixels()])).collect();
    for (samples, grey) in [(1, 30), (2, 60)] {
        viewer.update(Update::Drawn(first.serial, Drawn::Fewer(tiles(grey), samples)), 0.5);
        assert_eq!((viewer.canvas.picture().pixels()[0], viewer.full()), ([grey; 3], None));
        assert!(viewer.lines()[0].ends_with(&format!("{samples} samples and more")), "{:?}", viewer.lines());
    }
    assert!(viewer.tick(0.6).is_none());
    full(&mut viewer, first, 90, 1.0);
    assert_eq!(viewer.full().map(|full| full.pixels()[0]), Some([90; 3]));
}
