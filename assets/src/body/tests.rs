//! Laws that every mannequin keeps.

use super::*;

#[test]
fn average_body_is_built() {
    for sex in [Sex::Female, Sex::Male] {
        let body = Body::build(sex, &Measures::average(sex)).unwrap();
        assert!((6_000..=16_000).contains(&body.mesh.triangles.len()), "{}", body.mesh.triangles.len());
    }
}
