//! Rays: none is lost between two triangles, none leaves a closed room, and none writes what is no number.
#![allow(clippy::unwrap_used, missing_docs)]

#[path = "common/scans.rs"]
mod scans;
#[path = "common/scenes.rs"]
mod scenes;
#[path = "common/units.rs"]
mod units;

use bbrf::simulate::{
    Ball, Body, Bounces, Camera, Kept, Layer, Mesh, Picture, Place, Projection, Scene, Shape, Watch, plan,
};
use scans::Random;
use scenes::*;
use units::units;

type Vector = [f64; 3];

fn mesh(corners: &[Vector], triangles: &[[usize; 3]]) -> Body {
    Body { name: "mesh".to_owned(), shape: Shape::Mesh(Mesh::new(corners, triangles).unwrap()), material: 0 }
}

fn numbers(picture: &Picture) -> impl Iterator<Item = f32> {
    picture.layers.iter().flat_map(|(_, planes)| planes.iter().flatten().copied())
}

/// Three directions across each other, turned at random.
fn turned(random: &mut Random) -> [Vector; 3] {
    let [w, x, y, z] = [0; 4].map(|_| random.normal());
    let n = (w * w + x * x + y * y + z * z).sqrt();
    let [w, x, y, z] = [w / n, x / n, y / n, z / n];
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)],
        [2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)],
        [2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

/// Squares of two triangles whose common side lies on the middles of pixels.
#[test]
fn no_ray_passes_between_two_triangles() {
    let mut random = Random::new(3);
    let mut lost = 0;
    for _ in 0..25 {
        let axes = turned(&mut random);
        let centre = [0; 3].map(|_| random.between(-3.0, 3.0));
        let at =
            |x: f64, y: f64, z: f64| [0, 1, 2].map(|k| centre[k] + x * axes[0][k] + y * axes[1][k] + z * axes[2][k]);
        let corners = [at(-1.0, -1.0, 0.0), at(1.0, -1.0, 0.0), at(1.0, 1.0, 0.0), at(-1.0, 1.0, 0.0)];
        let sun = white("sun", Place::Directional(axes[2]));
        let mut scene = scene(vec![mesh(&corners, &[[0, 1, 2], [0, 2, 3]])], vec![grey(0.5)], vec![sun]);
        let projection = Projection::Orthographic { width: 1.9 };
        scene.camera = Camera::new(at(0.0, 0.0, 5.0), centre, axes[1], projection).unwrap();
        scene.size = (200, 200);
        scene.bounces = Bounces::Most(0);
        lost += luminance(&draw(&scene, &everything(&scene))).iter().filter(|value| **value == 0.0).count();
    }
    assert_eq!(lost, 0, "pixels between two triangles");
}

/// A fan of long triangles, seen along its hub and along all its sides.
#[test]
fn no_ray_passes_by_a_corner_of_many_triangles() {
    let mut random = Random::new(4);
    for _ in 0..10 {
        let axes = turned(&mut random);
        let at = |x: f64, y: f64, z: f64| [0, 1, 2].map(|k| x * axes[0][k] + y * axes[1][k] + z * axes[2][k]);
        let count = 7;
        let rim = (0..count).map(|k| f64::from(k) * std::f64::consts::TAU / f64::from(count)).map(f64::sin_cos);
        let corners: Vec<Vector> =
            std::iter::once(at(0.1, 0.2, 0.3)).chain(rim.map(|(y, x)| at(9.0 * x, 9.0 * y, 0.0))).collect();
        let count = count as usize;
        let triangles: Vec<[usize; 3]> = (0..count).map(|k| [0, 1 + k, 1 + (k + 1) % count]).collect();
        let sky = white("sky", Place::Surround);
        let mut scene = scene(vec![mesh(&corners, &triangles)], vec![grey(0.5)], vec![sky]);
        // So narrow that all pixels are within rounding of the hub.
        for width in [1e-15, 1e-12, 1e-3] {
            let projection = Projection::Orthographic { width };
            scene.camera = Camera::new(at(0.1, 0.2, 7.0), at(0.1, 0.2, 0.0), axes[1], projection).unwrap();
            scene.size = (41, 41);
            scene.bounces = Bounces::Most(0);
            scene.samples = 1;
            let picture = draw(&scene, &everything(&scene));
            let lost = luminance(&picture).iter().filter(|value| **value == 0.0).count();
            // Some of the sky may be hidden by the fan itself: not from its hub.
            assert_eq!(lost, 0, "{lost} of {} pixels of width {width}", 41 * 41);
        }
    }
}

fn cube() -> Body {
    let corners: Vec<Vector> =
        (0..8_u8).map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { 1.0 } else { -1.0 })).collect();
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[usize; 3]> = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    mesh(&corners, &triangles)
}

/// A closed room of triangles is dark inside, also where a path or a shadow ray begins in the very corner of two walls.
#[test]
fn no_light_comes_into_a_closed_room_of_triangles() {
    let lights = vec![
        white("sky", Place::Surround),
        white("sun", Place::Directional([0.6, 0.0, 0.8])),
        white("lamp", Place::Point([-5.0, 3.0, 0.7], 5.0)),
        white("lamp", Place::Point([3.0, -4.0, 1.5], 5.0)),
    ];
    let mut scene = scene(vec![cube()], vec![grey(0.9)], lights);
    scene.size = (33, 33);
    scene.samples = 8;
    // At an edge, at a corner, at the seam of two triangles of a wall.
    for at in [[0.5, 0.5, 0.0], [0.5, 0.5, 0.5], [0.5, 0.0, 0.0]] {
        for up in [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0]] {
            let projection = Projection::Orthographic { width: 0.5 };
            scene.camera = Camera::new([0.0; 3], at, up, projection).unwrap();
            let picture = draw(&scene, &everything(&scene));
            let lit = luminance(&picture).iter().filter(|value| **value != 0.0).count();
            assert_eq!(lit, 0, "lit pixels towards {at:?}");
        }
    }
}

/// What reflects nothing at its interface has none, for the plan and for the picture.
#[test]
fn an_interface_of_no_intensity_is_none() {
    let mut scene = scene(
        vec![ball([0.0; 3], 1.0, 0), floor(-1.0, 0)],
        vec![grey(0.7)],
        vec![white("sun", Place::Directional([0.6, 0.0, 0.8]))],
    );
    scene.bounces = Bounces::Most(3);
    scene.materials[0].specular = Some(gloss(0.0, 0.1));
    for intensity in [Vec::new(), vec![(400.0, 0.0), (700.0, 0.0)]] {
        scene.materials[0].intensity = intensity;
        let in_full = draw(&scene, &everything(&scene));
        let planned = plan(&scene, Kept::Colour, 0.0).unwrap();
        assert!(planned.bound.is_zero());
        let drawn = draw(&scene, &planned.choice.by_pixel());
        assert!(numbers(&drawn).zip(numbers(&in_full)).all(|(a, b)| a.to_bits() == b.to_bits()));
        let mut without = scene.clone();
        without.materials[0].specular = None;
        assert_eq!(in_full, draw(&without, &everything(&without)));
    }
}

/// The rays of parallel projection begin anywhere on the film: some of them in the ball, where light goes round.
#[test]
fn what_gives_more_than_it_gets_is_not_looked_at_from_within() {
    let lamp = white("lamp", Place::Point([0.2, 0.1, 0.0], 1.0));
    let mut scene = scene(vec![ball([0.0; 3], 1.0, 0)], vec![grey(1.2)], vec![lamp]);
    let projection = Projection::Orthographic { width: 4.0 };
    let draw =
        |scene: &Scene| Picture::draw(scene, &everything(scene), Kept::Colour, &[Layer::Total], &Watch::default());
    scene.camera = Camera::new([-1.5, 0.0, 0.0], [-1.5, 0.0, -5.0], [0.0, 1.0, 0.0], projection).unwrap();
    assert!(draw(&scene).is_err());
    scene.camera = Camera::new([-1.5, 0.0, 1.01], [-1.5, 0.0, -5.0], [0.0, 1.0, 0.0], projection).unwrap();
    assert!(draw(&scene).is_ok());
}

/// Parallel projection does not know how far the camera stands.
#[test]
fn a_ball_looks_the_same_from_any_distance() {
    let mut scene = scene(
        vec![ball([0.0; 3], 1.0, 0)],
        vec![grey(0.6)],
        vec![white("sun", Place::Directional([0.6, 0.0, 0.8])), white("lamp", Place::Point([1.5, 2.0, 1.0], 2.0))],
    );
    scene.materials[0].specular = Some(gloss(0.5, 0.05));
    scene.size = (90, 90);
    let projection = Projection::Orthographic { width: 2.5 };
    let mut seen_from = |direction: Vector, distance: f64| {
        scene.camera = Camera::new(direction.map(|x| distance * x), [0.0; 3], [0.0, 1.0, 0.0], projection).unwrap();
        draw(&scene, &everything(&scene))
    };
    for direction in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]] {
        let near = seen_from(direction, 4.0);
        for distance in [1e3, 1e6, 1e9, 1e12] {
            let far = seen_from(direction, distance);
            let most = numbers(&near).zip(numbers(&far)).map(|(a, b)| units(a, b)).max().unwrap();
            println!("from {distance:e} radii: {most} units in the last place");
            assert!(most <= 1, "from {distance:e} radii: {most} units in the last place");
        }
    }
}

/// So small that another colour space has a number for it, too.
fn is_small(value: f32) -> bool {
    value.abs() <= 1e36
}

#[test]
fn every_pixel_is_a_number() {
    for height in [0.0, 1e-300, 1e-160, 1e-20, 1e-12] {
        for reference in [1.0, 1e8, 1e300] {
            let lamp = white("lamp", Place::Point([0.0, 0.0, height], reference));
            let mut scene =
                scene(vec![floor(0.0, 0), ball([0.0, 0.0, 2.0], 1.0, 1)], vec![grey(0.7), grey(0.0)], vec![lamp]);
            scene.materials[0].specular = Some(gloss(0.5, 0.05));
            scene.materials[0].specular.as_mut().unwrap().denominator = bbrf::terms::Denominator::CosICosV;
            scene.bounces = Bounces::Most(2);
            scene.samples = 4;
            scene.size = (9, 9);
            for width in [1e-160, 1e-20, 1.0] {
                let projection = Projection::Orthographic { width };
                scene.camera = Camera::new([0.0, 0.0, 0.5], [0.0; 3], [0.0, 1.0, 0.0], projection).unwrap();
                for (bodies, choice) in [(2, everything(&scene)), (2, plan(&scene, Kept::Colour, 0.0).unwrap().choice)]
                {
                    assert_eq!(scene.bodies.len(), bodies);
                    let picture = draw(&scene, &choice);
                    assert!(numbers(&picture).all(is_small), "{height:e}, {reference:e}, {width:e}");
                }
            }
        }
    }
    // A ball alone, which is drawn another way.
    for radius in [1e-30, 1.0] {
        let lamp = white("lamp", Place::Point([0.0, 0.0, 2.0 * radius], 1e30));
        let mut scene = scene(vec![ball([0.0; 3], radius, 0)], vec![grey(0.7)], vec![lamp]);
        let projection = Projection::Orthographic { width: 3.0 * radius };
        scene.camera = Camera::new([0.0, 0.0, 9.0 * radius], [0.0; 3], [0.0, 1.0, 0.0], projection).unwrap();
        scene.materials[0].specular = Some(gloss(0.5, 0.05));
        for choice in [everything(&scene), plan(&scene, Kept::Colour, 0.0).unwrap().choice] {
            assert!(numbers(&draw(&scene, &choice)).all(is_small), "{radius:e}");
        }
    }
}

#[test]
fn a_ball_far_from_the_origin_keeps_its_digits() {
    let at = |centre: Vector, from: Vector| {
        let mut scene = scene(
            vec![Body { name: "ball".to_owned(), shape: Shape::Sphere(Ball { centre, radius: 1.0 }), material: 0 }],
            vec![grey(0.6)],
            vec![white("sun", Place::Directional([0.6, 0.0, 0.8]))],
        );
        scene.size = (64, 64);
        scene.camera = Camera::new(from, centre, [0.0, 1.0, 0.0], Projection::Orthographic { width: 2.5 }).unwrap();
        scene.materials[0].specular = Some(gloss(0.5, 0.05));
        draw(&scene, &everything(&scene))
    };
    let expected = at([0.0; 3], [0.0, 0.0, 5.0]);
    for far in [1e4, 1e6, 9e8] {
        let found = at([0.0, 0.0, -far], [0.0, 0.0, 5.0]);
        let most = numbers(&expected).zip(numbers(&found)).map(|(a, b)| units(a, b)).max().unwrap();
        assert!(most <= 1, "at {far:e} radii: {most} units in the last place");
    }
}
