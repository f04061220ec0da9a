! A host in Fortran: the one of host.c.
!
!     gfortran capi/examples/host.f90 -L target/release -lmoorline_c -o host && ./host scenes/oc3_catenary.toml
module moorline
  use, intrinsic :: iso_c_binding
  implicit none
  integer(c_int32_t), parameter :: abi_version = 1

  interface
    integer(c_int) function moorline_load(abi_version, path, simulation) bind(c)
      import
      integer(c_int32_t), value :: abi_version
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr), intent(out) :: simulation
    end function
    integer(c_int) function moorline_start(simulation, time) bind(c)
      import
      type(c_ptr), value :: simulation
      real(c_double), value :: time
    end function
    integer(c_int) function moorline_body_size(simulation, body, size) bind(c)
      import
      type(c_ptr), value :: simulation
      integer(c_size_t), value :: body
      integer(c_size_t), intent(out) :: size
    end function
    integer(c_int) function moorline_move(simulation, body, place, velocity, size) bind(c)
      import
      type(c_ptr), value :: simulation, velocity
      integer(c_size_t), value :: body, size
      real(c_double), intent(in) :: place(*)
    end function
    integer(c_int) function moorline_step(simulation, step) bind(c)
      import
      type(c_ptr), value :: simulation
      real(c_double), value :: step
    end function
    integer(c_int) function moorline_force(simulation, body, force, size) bind(c)
      import
      type(c_ptr), value :: simulation
      integer(c_size_t), value :: body, size
      real(c_double), intent(out) :: force(*)
    end function
    integer(c_int) function moorline_time(simulation, time) bind(c)
      import
      type(c_ptr), value :: simulation
      real(c_double), intent(out) :: time
    end function
    integer(c_int) function moorline_message(text, room, needed) bind(c)
      import
      character(kind=c_char), intent(out) :: text(*)
      integer(c_size_t), value :: room
      type(c_ptr), value :: needed
    end function
    integer(c_int) function moorline_close(simulation) bind(c)
      import
      type(c_ptr), value :: simulation
    end function
  end interface

contains

  subroutine must(code)
    integer(c_int), intent(in) :: code
    character(kind=c_char) :: text(512)
    integer(c_int) :: given
    integer :: i
    if (code == 0) return
    given = moorline_message(text, int(size(text), c_size_t), c_null_ptr)
    do i = 1, size(text)
      if (text(i) == c_null_char) exit
      write (*, '(a)', advance='no') text(i)
    end do
    write (*, *)
    error stop
  end subroutine
end module

program host
  use moorline
  implicit none
  real(c_double), parameter :: step = 0.05_c_double, pi = 3.141592653589793_c_double
  real(c_double) :: place(6) = 0, force(6), time
  type(c_ptr) :: mooring
  integer(c_size_t) :: freedom
  character(len=512) :: path
  integer :: k

  call get_command_argument(1, path)
  if (path == '') path = 'scenes/oc3_catenary.toml'
  call must(moorline_load(abi_version, trim(path)//c_null_char, mooring))
  call must(moorline_start(mooring, 0.0_c_double))
  call must(moorline_body_size(mooring, 0_c_size_t, freedom))
  do k = 1, 600
    call must(moorline_time(mooring, time))
    place(1) = 5 * min(time / 20, 1.0_c_double) * sin(2 * pi * time / 12)
    call must(moorline_move(mooring, 0_c_size_t, place, c_null_ptr, freedom))
    call must(moorline_step(mooring, step))
    call must(moorline_force(mooring, 0_c_size_t, force, freedom))
  end do
  call must(moorline_time(mooring, time))
  write (*, '(a,f0.2,a,3(es14.6),a)') 't = ', time, ' s, force', force(1:3), ' N'
  call must(moorline_close(mooring))
end program
