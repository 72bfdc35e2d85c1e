//! Starting the program as one of many ranks without MPI, which it detects by the launcher's
//! environment.

use super::command;

/// A command that every rank would do in full refuses many.
#[test]
fn unsharable_command_rejects_many_ranks() {
    for size in ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"] {
        let output = command(&["mesh", "data/meshes/spot.tri"]).env(size, "3").output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert_eq!(output.stdout, b"");
        assert!(stderr.contains("one of 3 ranks"), "{stderr}");
        let alone = command(&["completions", "bash"]).env(size, "1").output();
        assert_eq!(alone.unwrap().status.code(), Some(0));
    }
}
