//! What a user does to bodies between steps, all at once: whatever the filter knows may have
//! changed.

use super::super::rapier::math::{Pose, Real, Vector};
use super::super::rapier::prelude::*;
use super::scenes::Stage;

impl Stage {
    pub(super) fn zoo(&mut self) {
        let side = self.lattice(0.8, Vector::ZERO, 2.0);
        self.box_around(None, Vector::splat(side / 2.0), 6);
        self.world.integration_parameters.normalized_prediction_distance = 0.05;
    }

    /// A fifth of the bodies is disturbed in one of many ways.
    pub(super) fn disturb(&mut self) {
        let bodies: Vec<_> = self.world.rigid_bodies().map(|(handle, _)| handle).collect();
        let reach = (bodies.len() as Real).cbrt() / 2.0;
        for handle in bodies {
            if self.random.below(5) > 0 {
                continue;
            }
            let place = self.random.vector() * reach;
            match self.random.below(10) {
                0 => {
                    self.world.remove_body(handle);
                    self.drop_at(place, Vector::ZERO);
                }
                1 => {
                    let pose = Pose::from_parts(place, self.random.rotation());
                    self.change_body(handle, |body| body.set_position(pose, true));
                }
                2 => {
                    let speed = self.random.vector() * 30.0; // fast enough for continuous detection
                    self.change_body(handle, |body| body.set_linvel(speed, true));
                }
                3 => self.change_body(handle, RigidBody::sleep),
                4 => {
                    let types = [
                        RigidBodyType::Dynamic,
                        RigidBodyType::KinematicVelocityBased,
                        RigidBodyType::KinematicPositionBased,
                        RigidBodyType::Fixed,
                    ];
                    let kind = types[self.random.below(types.len())];
                    self.change_body(handle, |body| body.set_body_type(kind, true));
                }
                5 => self.change_body(handle, |body| {
                    body.set_soft_ccd_prediction(0.5);
                    body.enable_ccd(!body.is_ccd_enabled());
                }),
                6 => {
                    let groups = InteractionGroups::new(
                        Group::from_bits_truncate(1 << self.random.below(3)),
                        Group::from_bits_truncate(7 & !(1 << self.random.below(3))),
                        [InteractionTestMode::And, InteractionTestMode::Or][self.random.below(2)],
                    );
                    self.change_colliders(handle, |collider| collider.set_collision_groups(groups));
                }
                7 => self.change_colliders(handle, |collider| {
                    collider.set_sensor(!collider.is_sensor());
                    collider.set_active_collision_types(ActiveCollisionTypes::all());
                }),
                8 => {
                    let form = self.random.below(self.colliders.len());
                    let shape = self.colliders[form][0].shared_shape().clone();
                    self.change_colliders(handle, |collider| collider.set_shape(shape.clone()));
                }
                _ => self.change_colliders(handle, |collider| {
                    collider.set_contact_skin(0.1);
                    collider.set_enabled(!collider.is_enabled());
                }),
            }
        }
    }

    fn change_body(&mut self, handle: RigidBodyHandle, change: impl FnOnce(&mut RigidBody)) {
        if let Some(body) = self.world.bodies.get_mut(handle) {
            change(body);
        }
    }

    fn change_colliders(&mut self, handle: RigidBodyHandle, change: impl Fn(&mut Collider)) {
        let body = self.world.bodies.get(handle);
        for &collider in body.map_or(&[][..], |body| body.colliders()) {
            if let Some(collider) = self.world.colliders.get_mut(collider) {
                change(collider);
            }
        }
    }
}
