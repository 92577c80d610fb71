//! The kernels of the window, in the order of their keys.

use host_tools::engine::{ENGINES, Engine, PLANES12};
use host_tools::model::Model;
use host_tools::planes::scene::{Options, Planes, PlanesError};

/// Those that take any scene, as `intray render` has them, and the tracer of 1994 after them.
pub const KERNELS: [&dyn Engine; ENGINES.len() + 1] = {
    let mut kernels = [PLANES12; ENGINES.len() + 1];
    let mut place = 0;
    while place < ENGINES.len() {
        kernels[place] = ENGINES[place];
        place += 1;
    }
    kernels
};

/// The place of a kernel of a name.
#[must_use]
pub fn place(name: &str) -> Option<usize> {
    KERNELS.iter().position(|engine| engine.name() == name)
}

/// Why the kernel of a place has nothing to do with a scene, whatever its camera; none where it has.
#[must_use]
pub fn refusal(kernel: usize, model: &Model) -> Option<String> {
    let is_planes = KERNELS.get(kernel).is_some_and(|engine| engine.id() == PLANES12.id());
    let error = is_planes.then(|| Planes::new(model, &Options::default()).err()).flatten()?;
    match error {
        PlanesError::Triangles(count) => {
            let names = ENGINES.map(|engine| engine.name()).join(", ");
            Some(format!(
                "planes12 traces spheres alone, and the scene has {count} triangles; for these there are {names}"
            ))
        }
        PlanesError::Empty | PlanesError::Refracts(_) => Some(error.to_string()),
        // Of one camera; another may do.
        PlanesError::Direction { .. } | PlanesError::Scene(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use host_tools::model::{Material, MaterialKind, Sphere, Triangle};

    #[test]
    fn the_tracer_of_spheres_refuses_what_else_there_is_by_name() {
        let planes = ENGINES.len();
        let sphere = Sphere { centre: DVec3::ZERO, radius: 0.5, material: 0 };
        let triangle = Triangle { vertices: [0; 3], normals: None, material: 0 };
        let spheres = Model { spheres: vec![sphere], ..Model::default() };
        let both = Model { positions: vec![DVec3::ZERO], triangles: vec![triangle; 2], ..spheres.clone() };
        let mut glass = spheres.clone();
        glass.materials =
            vec![Material { name: "glass".into(), kind: MaterialKind::Dielectric, ..Material::default() }];
        assert_eq!(refusal(planes, &spheres), None);
        assert_eq!(
            refusal(planes, &both).as_deref(),
            Some(
                "planes12 traces spheres alone, and the scene has 2 triangles; for these there are exact29, exact20, exact14, \
                 hanika-c, hanika-cd, hanika-cons, f32, f64"
            )
        );
        assert!(refusal(planes, &glass).unwrap().contains("`glass`"));
        assert!((0..planes).all(|kernel| refusal(kernel, &both).is_none()));
    }

    #[test]
    fn every_kernel_has_its_place() {
        for (number, engine) in KERNELS.into_iter().enumerate() {
            assert_eq!(place(engine.name()), Some(number));
        }
        assert_eq!((place("planes12"), place("exact41")), (Some(ENGINES.len()), None));
    }
}
