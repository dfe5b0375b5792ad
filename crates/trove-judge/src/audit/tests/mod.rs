use std::collections::BTreeSet;

use glam::DVec3;
use trove_model::{Class, InPatches, Occlusion, Raster, Role};

use super::flow::{self, Looked};
use super::{Audit, Check, LabelForm, LabelledFrame, LabelledSweep, audit, frame};

mod street;

use street::{CAR, HOUSE, Street, whole};

const FRAME: &str = "street/v00/k000/ego.A";
const LATER: &str = "street/v00/k001/ego.A";
const SWEEP: &str = "street/v00/k000/ego.LIDAR";

fn look(street: &Street) -> Audit {
    let root = tempfile::tempdir().unwrap();
    street.lay_out(root.path());
    audit(root.path(), Some(LabelForm::Trove), street, &|_, _| true).unwrap().1
}

/// Shifts an image by columns, its rim repeated.
fn shift<T: Copy>(raster: &mut Option<Raster<T>>, by: u32) {
    let old = raster.as_ref().unwrap();
    let moved = Raster::from_fn(old.width, old.height, |x, y| *old.at(x.saturating_sub(by), y));
    *raster = Some(moved);
}

fn change<T>(raster: &mut Option<Raster<T>>, change: impl FnMut(&mut T)) {
    raster.as_mut().unwrap().data.iter_mut().for_each(change);
}

fn change_known<T>(image: &mut Option<InPatches<T>>, change: impl FnMut(&mut T)) {
    image.as_mut().unwrap().raster.data.iter_mut().for_each(change);
}

/// A fault, and the check that is there to find it.
type Fault = (&'static str, Check, fn(&mut LabelledFrame));

/// What may be wrong with a frame.
const FAULTS: [Fault; 43] = [
    ("a file is damaged", Check::Files, |f| f.damage.push("depth.exr: cut short".into())),
    ("the image is black", Check::Image, |f| change(&mut f.rgb, |rgb| *rgb = [0; 3])),
    ("the image is blown", Check::Image, |f| change(&mut f.rgb, |rgb| *rgb = [255; 3])),
    ("the image is upside down", Check::Image, |f| f.rgb.as_mut().unwrap().data.reverse()),
    ("the image is 12 pixels aside", Check::Image, |f| shift(&mut f.rgb, 12)),
    ("an id is not listed", Check::Ids, |f| {
        change(&mut f.instance, |id| {
            if *id == CAR {
                *id = 99
            }
        });
    }),
    ("an id is listed twice", Check::Ids, |f| {
        let row = f.table.objects[0].clone();
        f.table.objects.insert(0, row);
    }),
    ("a car is labelled a truck", Check::Classes, |f| {
        change(&mut f.class, |class| {
            if *class == Class::Car {
                *class = Class::Truck
            }
        });
    }),
    ("classes are a pixel aside", Check::Classes, |f| shift(&mut f.class, 1)),
    ("a car has no id", Check::Classes, |f| {
        change(&mut f.instance, |id| {
            if *id == CAR {
                *id = 0
            }
        })
    }),
    ("a class has another's id", Check::Classes, |f| f.table.objects[0].class_id = 5),
    ("a box is a pixel too wide", Check::Masks, |f| f.table.objects[0].visible_box.as_mut().unwrap()[2] += 1),
    ("pixels are counted wrongly", Check::Masks, |f| f.table.objects[0].visible_px -= 1),
    ("fewer pixels are amodal than visible", Check::Masks, |f| f.table.objects[0].amodal_px = 3),
    ("occlusion is its opposite", Check::Masks, |f| f.table.objects[0].occlusion = 1.0),
    ("depth is negative", Check::Depth, |f| change(&mut f.depth_m, |depth| *depth = -*depth)),
    ("the sky has a depth", Check::Depth, |f| change(&mut f.depth_m, |depth| *depth = depth.min(1000.0))),
    ("depth is range", Check::Flow, |f| {
        let eye = f.eye().unwrap();
        let depth = f.depth_m.as_mut().unwrap();
        *depth = Raster::from_fn(depth.width, depth.height, |x, y| {
            (f64::from(*depth.at(x, y)) / eye.direction([x, y]).unwrap().z) as f32
        });
    }),
    ("depth is in centimetres", Check::Flow, |f| change(&mut f.depth_m, |depth| *depth *= 100.0)),
    ("normals are not unit", Check::Normals, |f| change_known(&mut f.normal, |n| *n = n.map(|part| part * 0.5))),
    ("normals point away", Check::Normals, |f| change_known(&mut f.normal, |n| *n = n.map(|part| -part))),
    ("normals are in World", Check::Surfaces, |f| {
        let pose = f.eye().unwrap().world_from_camera;
        change_known(&mut f.normal, |n| {
            *n = pose.transform_vector3(DVec3::from_array(n.map(f64::from))).as_vec3().to_array();
        });
    }),
    ("a 3D box is turned", Check::Boxes, |f| {
        let body = &mut f.table.objects[0].world_from_body;
        (body[0][0], body[0][1], body[1][0], body[1][1]) = (0.0, -1.0, 1.0, 0.0);
    }),
    ("a 3D box stands 2 m aside", Check::Boxes, |f| f.table.objects[0].world_from_body[1][3] += 2.0),
    ("flow has its sign turned", Check::Flow, |f| change_known(&mut f.flow[0], |flow| *flow = flow.map(|part| -part))),
    ("flow is that of half the scale", Check::Flow, |f| {
        change_known(&mut f.flow[0], |flow| *flow = flow.map(|part| part / 2.0))
    }),
    ("flow takes rows for columns", Check::Flow, |f| change_known(&mut f.flow[0], |flow| flow.reverse())),
    ("the car's flow is the camera's alone", Check::FlowEnds, |f| {
        let (eye, other) = (f.eye().unwrap(), frame::rigid(&f.table.world_from_camera_next.unwrap(), "").unwrap());
        let (depth, instance) = (f.depth_m.as_ref().unwrap(), f.instance.as_ref().unwrap());
        let flow = &mut f.flow[0].as_mut().unwrap().raster;
        for (pixel, _) in frame::pixels(instance).filter(|(_, id)| **id == CAR) {
            let point =
                eye.world_from_camera.transform_point3(eye.point(pixel, *depth.at(pixel[0], pixel[1])).unwrap());
            let end = eye.lens.project(other.inverse().transform_point3(point + DVec3::new(0.0, 2.0, 0.0))).unwrap();
            let start = glam::DVec2::new(f64::from(pixel[0]) + 0.5, f64::from(pixel[1]) + 0.5);
            *flow.at_mut(pixel[0], pixel[1]) = (end - start).as_vec2().to_array();
        }
    }),
    ("flow back is flow forth", Check::FlowReturns, |f| {
        change_known(&mut f.flow[0], |flow| *flow = [flow[0] + 3.0, flow[1]]);
    }),
    ("occlusion is inside out", Check::Occlusion, |f| {
        change(&mut f.occluded[0], |occlusion| {
            *occlusion = match occlusion {
                Occlusion::Seen => Occlusion::Hidden,
                Occlusion::Hidden => Occlusion::Seen,
                Occlusion::Undefined => Occlusion::Undefined,
            }
        });
    }),
    ("the camera's pose is mirrored", Check::Camera, |f| {
        f.table.world_from_camera[0].iter_mut().take(3).for_each(|part| *part = -*part);
    }),
    ("a focal length is negative", Check::Camera, |f| f.table.intrinsics[1][1] *= -1.0),
    ("panoptic labels are of another frame", Check::Panoptic, |f| shift(&mut f.panoptic, 1)),
    ("a board is the rider of a car", Check::Classes, |f| {
        change(&mut f.part, |part| *part = part.map(|_| Role::Cyclist));
    }),
    ("boards are everywhere", Check::Classes, |f| change(&mut f.part, |part| *part = Some(Role::ShopSign))),
    ("yards are everywhere", Check::Classes, |f| change(&mut f.part, |part| *part = Some(Role::Paved))),
    ("car parks are everywhere", Check::Classes, |f| change(&mut f.part, |part| *part = Some(Role::CarPark))),
    ("earth is everywhere", Check::Classes, |f| change(&mut f.part, |part| *part = Some(Role::Unpaved))),
    ("range is depth", Check::Depth, |f| f.range_m = f.depth_m.clone().map(whole)),
    ("World's normals are the camera's", Check::Normals, |f| f.normal_world = f.normal.clone()),
    ("object coordinates are mirrored", Check::Boxes, |f| {
        change_known(&mut f.object_coordinates, |[x, _, _]| *x = 1.0 - *x);
    }),
    ("scene flow is the camera's", Check::Flow, |f| {
        change_known(&mut f.scene_flow[0], |flow| flow[0] -= 0.8);
    }),
    ("the next camera is elsewhere", Check::Camera, |f| f.table.world_from_camera_next.as_mut().unwrap()[0][3] += 0.1),
];

#[test]
fn a_street_in_closed_form_has_no_fault_and_every_check_looks_at_it() {
    assert_eq!(look(&Street::new().in_patches(2)).findings, []);
    let audit = look(&Street::new());
    assert_eq!(audit.findings, []);
    assert_eq!(audit.frames, 4);
    let made: BTreeSet<Check> = audit.tallies.keys().copied().collect();
    let not_made: Vec<Check> = Check::ALL.into_iter().filter(|check| !made.contains(check)).collect();
    // Only other forms have outlines; nobody is about who has keypoints.
    assert_eq!(not_made, [Check::Outlines, Check::Keypoints]);
}

#[test]
fn every_planted_fault_is_found_by_its_check() {
    for every in [1, 2] {
        for (name, check, plant) in FAULTS {
            let mut street = Street::new().in_patches(every);
            plant(street.frames.get_mut(FRAME).unwrap());
            let audit = look(&street);
            let found: BTreeSet<&str> = audit.findings.iter().map(|finding| finding.check.name()).collect();
            assert!(found.contains(check.name()), "{name}: expected {}, found {found:?}", check.name());
        }
    }
}

#[test]
fn a_point_is_at_its_depth_within_what_a_pixel_covers_of_its_surface() {
    let mut street = Street::new();
    change(&mut street.frames.get_mut(LATER).unwrap().depth_m, |depth| *depth *= 1.15);
    let [here, there] = [FRAME, LATER].map(|place| Looked::at(&street.frames[place]));
    let [ours, theirs] = [&here, &there].map(|looked| looked.eye.as_ref().unwrap());
    let [class, class_there] = [&here, &there].map(|looked| looked.frame.class.as_ref().unwrap());
    let depth_m = here.frame.depth_m.as_ref().unwrap();
    let is_road = |class| class == Class::Road;
    let [mut flat, mut facing] = [0; 2];
    for [x, y] in frame::spread(class.width, class.height, u32::MAX).filter(|&[x, y]| is_road(*class.at(x, y))) {
        let point = ours.world_from_camera.transform_point3(ours.point([x, y], *depth_m.at(x, y)).unwrap());
        let Some((end, _)) = theirs.sees(point) else { continue };
        if !frame::around(class_there, end).all(is_road) {
            continue;
        }
        // The road is level: height over distance is the cosine between its normal and the line of sight.
        let eye_world = theirs.world_from_camera.translation;
        let covered = point.distance(eye_world) / (eye_world.z * theirs.lens.fx_px);
        let is_there = flow::is_at_depth(&here, &there, [x, y], end);
        if covered > 0.17 {
            flat += 1;
            assert_eq!(is_there, Some(true), "{x}, {y}: {covered}");
        } else if covered < 0.04 {
            facing += 1;
            assert_eq!(is_there, Some(false), "{x}, {y}: {covered}");
        }
    }
    assert!(flat > 100 && facing > 1000, "{flat}, {facing}");
}

#[test]
fn faults_between_views_times_and_sensors_are_found() {
    let expect = |name: &str, check: Check, plant: &dyn Fn(&mut Street)| {
        let mut street = Street::new();
        plant(&mut street);
        let found: BTreeSet<&str> = look(&street).findings.iter().map(|finding| finding.check.name()).collect();
        assert!(found.contains(check.name()), "{name}: expected {}, found {found:?}", check.name());
    };
    let swap = |street: &mut Street| {
        for frame in [FRAME, "street/v00/k000/ego.B"] {
            for row in &mut street.frames.get_mut(frame).unwrap().table.objects {
                row.track_token = format!("{} too", row.track_token);
            }
        }
    };
    expect("an id is another track's", Check::Tracks, &swap);
    expect("a car jumps", Check::Tracks, &|street| {
        for (place, frame) in &mut street.frames {
            let aside = if place.contains("k001") { 60.0 } else { 0.0 };
            frame.table.objects[0].world_from_body[1][3] += aside;
        }
    });
    expect("two views tell two places", Check::Tracks, &|street| {
        street.frames.get_mut(FRAME).unwrap().table.objects[0].world_from_body[0][3] += 0.2;
    });
    expect("a house is another's in one view", Check::Views, &|street| {
        change(&mut street.frames.get_mut(FRAME).unwrap().instance, |id| {
            if *id == HOUSE {
                *id = 8
            }
        });
    });
    expect("one view's depth is too small", Check::Views, &|street| {
        change(&mut street.frames.get_mut(LATER).unwrap().depth_m, |depth| *depth *= 0.7);
    });
    let sweep = |plant: fn(&mut LabelledSweep)| move |street: &mut Street| plant(street.sweeps.get_mut(SWEEP).unwrap());
    expect(
        "the LiDAR is turned",
        Check::Lidar,
        &sweep(|sweep| {
            sweep.points.iter_mut().for_each(|point| point.position_m.y = -point.position_m.y);
        }),
    );
    expect(
        "ranges are too short",
        Check::Lidar,
        &sweep(|sweep| {
            sweep.points.iter_mut().for_each(|point| point.position_m *= 0.7);
        }),
    );
    expect(
        "points have another class",
        Check::Lidar,
        &sweep(|sweep| {
            sweep.points.iter_mut().for_each(|point| {
                if point.class == Class::Road {
                    point.class = Class::Sidewalk;
                }
            });
        }),
    );
    expect("a point too many is told", Check::Lidar, &sweep(|sweep| sweep.table.points += 1));
}

#[test]
fn a_check_has_a_name_of_its_own() {
    let names: BTreeSet<&str> = Check::ALL.iter().map(|check| check.name()).collect();
    assert_eq!(names.len(), Check::ALL.len());
}
