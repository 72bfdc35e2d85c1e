//! Started as one of many ranks, without MPI: the launcher is known by its environment alone.

use super::command;

#[test]
fn a_command_that_every_rank_would_do_in_full_refuses_many() {
    for size in ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"] {
        let output = command(&["mesh", "data/meshes/spot.tri"])
            .env(size, "3")
            .output()
            .unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert_eq!(output.stdout, b"");
        assert!(stderr.contains("one of 3 ranks"), "{stderr}");
        let alone = command(&["completions", "bash"]).env(size, "1").output();
        assert_eq!(alone.unwrap().status.code(), Some(0));
    }
}
