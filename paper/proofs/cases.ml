(* Reads cases of Rust's functions, "name inputs = outputs" in hexadecimal bits, and runs Coq's on the
   same inputs. Prints how many cases each function had; fails on a difference or a function without
   cases. *)

let functions = Functions.[
  "outward", run_outward; "widen", run_widen; "inflate", run_inflate; "spheres", run_spheres;
  "rotation", run_rotation; "transform", run_transform; "world_ball", run_world_ball;
  "axes", run_axes; "refit", run_refit; "slab", run_slab; "cells", run_cells; "stays", run_stays;
  "reach", run_reach; "cube", run_cube; "cubes", run_cubes; "support", run_support;
  "ordops", run_ordops;
]

let number word = Big_int_Z.(big_int_of_string ("0x" ^ word))
let words text = List.filter (( <> ) "") (String.split_on_char ' ' text)

let counts = Hashtbl.create 32
let differences = ref 0

let compare_case line =
  match String.split_on_char '=' line with
  | [ left; right ] ->
    let name, inputs = match words left with n :: i -> n, i | [] -> failwith line in
    let found = (List.assoc name functions) (List.map number inputs) in
    let expected = List.map number (words right) in
    Hashtbl.replace counts name (1 + try Hashtbl.find counts name with Not_found -> 0);
    if not (List.equal Big_int_Z.eq_big_int found expected) then begin
      incr differences;
      if !differences <= 10 then
        Printf.printf "DIFFERENT %s\n  Coq: %s\n" line
          (String.concat " " (List.map (fun n -> Z.format "%x" n) found))
    end
  | _ -> failwith ("not a case: " ^ line)

let () =
  (try while true do compare_case (input_line stdin) done with End_of_file -> ());
  let count (name, _) = try Hashtbl.find counts name with Not_found -> 0 in
  List.iter (fun entry -> if count entry = 0 then failwith (fst entry ^ " has no case")) functions;
  let all = List.fold_left (fun sum entry -> sum + count entry) 0 functions in
  Printf.printf "%d cases of %d functions, %d differences\n" all (List.length functions) !differences;
  exit (if !differences = 0 then 0 else 1)
