use sdop_judge::{Claim, judge_function, judge_pair_test};

#[test]
fn sweep_misses_no_pair() {
    let sweep = judge_function(|_, frame| mine::sweep(&frame.boxes));
    sweep.claims(Claim::Aabb).assert();
}

#[test]
fn test_misses_no_pair() {
    let test = judge_pair_test(|_, frame, [i, j]| mine::meet(&frame.boxes[i], &frame.boxes[j]));
    test.claims(Claim::Aabb).assert();
}
