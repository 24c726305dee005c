#include "generator/program/taken_names.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <unordered_set>

namespace hamgen {

namespace {

// Of all headers of ISO C and C++ and those of POSIX that a program of numbers may include (not of
// terminals, object files and network databases), as glibc 2.36 and g++ 12 have them.  Names that
// begin with an underscore or have two in a row belong to the implementation anyway.
constexpr std::string_view kMacros =
    " ACCESSPERMS AF_DECnet AIO_PRIO_DELTA_MAX ALLPERMS AT_EACCESS AT_EMPTY_PATH AT_FDCWD"
    " AT_NO_AUTOMOUNT AT_RECURSIVE AT_REMOVEDIR AT_STATX_DONT_SYNC AT_STATX_FORCE_SYNC"
    " AT_STATX_SYNC_AS_STAT AT_STATX_SYNC_TYPE AT_SYMLINK_FOLLOW AT_SYMLINK_NOFOLLOW BC_BASE_MAX"
    " BC_DIM_MAX BC_SCALE_MAX BC_STRING_MAX BIG_ENDIAN BOOL_MAX BOOL_WIDTH BUFSIZ BYTE_ORDER"
    " CHARCLASS_NAME_MAX CLOSE_RANGE_CLOEXEC CLOSE_RANGE_UNSHARE COLL_WEIGHTS_MAX CPU_SETSIZE"
    " CSIGNAL DECIMAL_DIG DEFFILEMODE DELAYTIMER_MAX DN_ACCESS DN_ATTRIB DN_CREATE DN_DELETE"
    " DN_MODIFY DN_MULTISHOT DN_RENAME DT_BLK DT_CHR DT_DIR DT_FIFO DT_LNK DT_REG DT_SOCK"
    " DT_UNKNOWN DT_WHT E2BIG EACCES EADDRINUSE EADDRNOTAVAIL EADV EAFNOSUPPORT EAGAIN EALREADY"
    " EBADE EBADF EBADFD EBADMSG EBADR EBADRQC EBADSLT EBFONT EBUSY ECANCELED ECHILD ECHRNG ECOMM"
    " ECONNABORTED ECONNREFUSED ECONNRESET EDEADLK EDEADLOCK EDESTADDRREQ EDOM EDOTDOT EDQUOT"
    " EEXIST EFAULT EFBIG EHOSTDOWN EHOSTUNREACH EHWPOISON EIDRM EILSEQ EINPROGRESS EINTR EINVAL"
    " EIO EISCONN EISDIR EISNAM EKEYEXPIRED EKEYREJECTED EKEYREVOKED EL2HLT EL2NSYNC EL3HLT"
    " EL3RST ELIBACC ELIBBAD ELIBEXEC ELIBMAX ELIBSCN ELNRNG ELOOP EMEDIUMTYPE EMFILE EMLINK"
    " EMSGSIZE EMULTIHOP ENAMETOOLONG ENAVAIL ENETDOWN ENETRESET ENETUNREACH ENFILE ENOANO"
    " ENOBUFS ENOCSI ENODATA ENODEV ENOENT ENOEXEC ENOKEY ENOLCK ENOLINK ENOMEDIUM ENOMEM ENOMSG"
    " ENONET ENOPKG ENOPROTOOPT ENOSPC ENOSR ENOSTR ENOSYS ENOTBLK ENOTCONN ENOTDIR ENOTEMPTY"
    " ENOTNAM ENOTRECOVERABLE ENOTSOCK ENOTSUP ENOTTY ENOTUNIQ ENXIO EOF EOPNOTSUPP EOVERFLOW"
    " EOWNERDEAD EPERM EPFNOSUPPORT EPIPE EPROTO EPROTONOSUPPORT EPROTOTYPE ERANGE EREMCHG"
    " EREMOTE EREMOTEIO ERESTART ERFKILL EROFS ESHUTDOWN ESOCKTNOSUPPORT ESPIPE ESRCH ESRMNT"
    " ESTALE ESTRPIPE ETIME ETIMEDOUT ETOOMANYREFS ETXTBSY EUCLEAN EUNATCH EUSERS EWOULDBLOCK"
    " EXDEV EXFULL EXPR_NEST_MAX FALSE FAPPEND FASYNC FD_CLOEXEC FD_SETSIZE FFSYNC FILENAME_MAX"
    " FIOGETOWN FIOSETOWN FNDELAY FNONBLOCK FOPEN_MAX F_ADD_SEALS F_DUPFD F_DUPFD_CLOEXEC F_EXLCK"
    " F_GETFD F_GETFL F_GETLEASE F_GETLK F_GETLK64 F_GETOWN F_GETOWN_EX F_GETPIPE_SZ F_GETSIG"
    " F_GET_FILE_RW_HINT F_GET_RW_HINT F_GET_SEALS F_LOCK F_NOTIFY F_OFD_GETLK F_OFD_SETLK"
    " F_OFD_SETLKW F_OK F_RDLCK F_SEAL_FUTURE_WRITE F_SEAL_GROW F_SEAL_SEAL F_SEAL_SHRINK"
    " F_SEAL_WRITE F_SETFD F_SETFL F_SETLEASE F_SETLK F_SETLK64 F_SETLKW F_SETLKW64 F_SETOWN"
    " F_SETOWN_EX F_SETPIPE_SZ F_SETSIG F_SET_FILE_RW_HINT F_SET_RW_HINT F_SHLCK F_TEST F_TLOCK"
    " F_ULOCK F_UNLCK F_WRLCK HOST_NAME_MAX I INFINITY IOV_MAX LINE_MAX LITTLE_ENDIAN LM_ID_BASE"
    " LM_ID_NEWLM LOGIN_NAME_MAX L_INCR L_SET L_XTND L_ctermid L_cuserid L_tmpnam MATH_ERREXCEPT"
    " MATH_ERRNO MAXFLOAT MAXNAMLEN MAX_CANON MAX_HANDLE_SZ MAX_INPUT MB_CUR_MAX MB_LEN_MAX"
    " MINSIGSTKSZ MLOCK_ONFAULT MOD_CLKA MOD_CLKB MOD_ESTERROR MOD_FREQUENCY MOD_MAXERROR"
    " MOD_MICRO MOD_NANO MOD_OFFSET MOD_STATUS MOD_TAI MOD_TIMECONST MQ_PRIO_MAX MS_ASYNC"
    " MS_INVALIDATE MS_SYNC NAME_MAX NAN NFDBITS NGREG NGROUPS_MAX NSIG NULL NZERO ONCE_FLAG_INIT"
    " O_ACCMODE O_APPEND O_ASYNC O_CLOEXEC O_CREAT O_DIRECT O_DIRECTORY O_DSYNC O_EXCL O_FSYNC"
    " O_LARGEFILE O_NDELAY O_NOATIME O_NOCTTY O_NOFOLLOW O_NONBLOCK O_PATH O_RDONLY O_RDWR"
    " O_RSYNC O_SYNC O_TMPFILE O_TRUNC O_WRONLY PATH_MAX PDP_ENDIAN PF_DECnet PIPE_BUF"
    " PKEY_DISABLE_ACCESS PKEY_DISABLE_WRITE POLLERR POLLHUP POLLIN POLLMSG POLLNVAL POLLOUT"
    " POLLPRI POLLRDBAND POLLRDHUP POLLRDNORM POLLREMOVE POLLWRBAND POLLWRNORM P_tmpdir RAND_MAX"
    " REGS_FIXED REGS_REALLOCATE REGS_UNALLOCATED RE_BACKSLASH_ESCAPE_IN_LISTS RE_BK_PLUS_QM"
    " RE_CARET_ANCHORS_HERE RE_CHAR_CLASSES RE_CONTEXT_INDEP_ANCHORS RE_CONTEXT_INDEP_OPS"
    " RE_CONTEXT_INVALID_DUP RE_CONTEXT_INVALID_OPS RE_DEBUG RE_DOT_NEWLINE RE_DOT_NOT_NULL"
    " RE_DUP_MAX RE_HAT_LISTS_NOT_NEWLINE RE_ICASE RE_INTERVALS RE_INVALID_INTERVAL_ORD"
    " RE_LIMITED_OPS RE_NEWLINE_ALT RE_NO_BK_BRACES RE_NO_BK_PARENS RE_NO_BK_REFS RE_NO_BK_VBAR"
    " RE_NO_EMPTY_RANGES RE_NO_GNU_OPS RE_NO_POSIX_BACKTRACKING RE_NO_SUB RE_NREGS RE_SYNTAX_AWK"
    " RE_SYNTAX_ED RE_SYNTAX_EGREP RE_SYNTAX_EMACS RE_SYNTAX_GNU_AWK RE_SYNTAX_GREP"
    " RE_SYNTAX_POSIX_AWK RE_SYNTAX_POSIX_BASIC RE_SYNTAX_POSIX_EGREP RE_SYNTAX_POSIX_EXTENDED"
    " RE_SYNTAX_POSIX_MINIMAL_BASIC RE_SYNTAX_POSIX_MINIMAL_EXTENDED RE_SYNTAX_SED"
    " RE_TRANSLATE_TYPE RE_UNMATCHED_RIGHT_PAREN_ORD RLIM64_INFINITY RTSIG_MAX R_OK SA_INTERRUPT"
    " SA_NOCLDSTOP SA_NOCLDWAIT SA_NODEFER SA_NOMASK SA_ONESHOT SA_ONSTACK SA_RESETHAND"
    " SA_RESTART SA_SIGINFO SA_STACK SEM_FAILED SEM_VALUE_MAX SIGABRT SIGALRM SIGBUS SIGCHLD"
    " SIGCLD SIGCONT SIGFPE SIGHUP SIGILL SIGINT SIGIO SIGIOT SIGKILL SIGPIPE SIGPOLL SIGPROF"
    " SIGPWR SIGQUIT SIGRTMAX SIGRTMIN SIGSEGV SIGSTKFLT SIGSTKSZ SIGSTOP SIGSYS SIGTERM SIGTRAP"
    " SIGTSTP SIGTTIN SIGTTOU SIGURG SIGUSR1 SIGUSR2 SIGVTALRM SIGWINCH SIGXCPU SIGXFSZ"
    " SIOCATMARK SIOCGPGRP SIOCGSTAMPNS_OLD SIOCGSTAMP_OLD SIOCSPGRP SNAN SNANF SNANF128 SNANF32"
    " SNANF32X SNANF64 SNANF64X SNANL SOMAXCONN SSIZE_MAX SS_DISABLE SS_ONSTACK STDERR_FILENO"
    " STDIN_FILENO STDOUT_FILENO S_BLKSIZE S_IEXEC S_IFBLK S_IFCHR S_IFDIR S_IFIFO S_IFLNK S_IFMT"
    " S_IFREG S_IFSOCK S_IREAD S_IRGRP S_IROTH S_IRUSR S_IRWXG S_IRWXO S_IRWXU S_ISGID S_ISUID"
    " S_ISVTX S_IWGRP S_IWOTH S_IWRITE S_IWUSR S_IXGRP S_IXOTH S_IXUSR TIMER_ABSTIME TIME_UTC"
    " TMP_MAX TRUE TSS_DTOR_ITERATIONS TTY_NAME_MAX UIO_MAXIOV UTIME_NOW UTIME_OMIT WAIT_ANY"
    " WAIT_MYPGRP WCONTINUED WCOREFLAG WEOF WEXITED WNOHANG WNOWAIT WORD_BIT WSTOPPED WUNTRACED"
    " W_OK X_OK basename complex d_fileno errno i386 imaginary linux math_errhandling no_argument"
    " optional_argument required_argument sa_handler sa_sigaction sched_priority si_addr"
    " si_addr_lsb si_arch si_band si_call_addr si_fd si_int si_lower si_overrun si_pid si_pkey"
    " si_ptr si_status si_stime si_syscall si_timerid si_uid si_upper si_utime si_value"
    " sigev_notify_attributes sigev_notify_function st_atime st_ctime st_mtime stderr stdin"
    " stdout unix"
    " ";

// Families of macros: a name in capitals that goes on in the same way is taken for one of them.
constexpr std::string_view kMacroFamilies =
    " ADJ_ AF_ ATOMIC_ BUS_ CHAR_ CLD_ CLOCKS_ CLOCK_ CLONE_ DBL_ DLFO_ EXIT_ FALLOC_ FE_ FLT128_"
    " FLT_ FPE_ FP_ GLOB_ HAMGEN_ HUGE_ ILL_ INT16_ INT32_ INT64_ INT8_ INTMAX_ INTPTR_ INT_"
    " ITIMER_ LC_ LDBL_ LLONG_ LOCK_ LONG_ MADV_ MAP_ MCL_ MFD_ MREMAP_ MSG_ M_ NL_ PF_ POLL_"
    " POSIX_ PRIO_ PROT_ PTHREAD_ PTRDIFF_ QUADMATH_ REG_ RENAME_ RLIMIT_ RLIM_ RTLD_ RUSAGE_"
    " RWF_ RWH_ SCHAR_ SCHED_ SCM_ SEEK_ SEGV_ SHRT_ SHUT_ SIGEV_ SIG_ SIZE_ SI_ SOCK_ SOL_"
    " SO_ SPLICE_ STATX_ STA_ SYNC_ TRAP_ UCHAR_ UINT16_ UINT32_ UINT64_ UINT8_ UINTMAX_"
    " UINTPTR_ UINT_ ULLONG_ ULONG_ USHRT_ WCHAR_ WINT_ XATTR_"
    " ";

// Functions, types and variables.
constexpr std::string_view kGlobals =
    " Dl_info Dl_serinfo Dl_serpath Eigen a64l abort abs accept accept4 access acct acos acosh"
    " adjtime alarm aligned_alloc alloca alphasort arc4random arc4random_buf arc4random_uniform"
    " asctime asctime_r asin asinh asprintf at_quick_exit atan atan2 atanh atexit atof atoi atol"
    " atoll basename bcmp bcopy bind brk bsearch btowc bzero c16rtomb c32rtomb c8rtomb cabs cacos"
    " cacosh call_once calloc canonicalize canonicalize_file_name carg casin casinh catan catanh"
    " cbrt ccos ccosh ceil cexp chdir chmod chown chroot cimag clearenv clearerr"
    " clearerr_unlocked clock clog clog10 clone close close_range closedir closefrom cmsghdr"
    " confstr conj connect copy_file_range copysign cos cosh cpow cproj creal creat crypt csin"
    " csinh csqrt ctan ctanh ctermid ctime ctime_r cuserid daddl daemon daylight ddivl dfmal"
    " difftime dirent dirfd dirname div dl_find_object dladdr dladdr1 dlclose dlerror dlinfo"
    " dlmopen dlopen dlsym dlvsym dmull dprintf drand48 drand48_data drand48_r drem dsqrtl dsubl"
    " dup dup2 dup3 duplocale dysize eaccess ecvt ecvt_r endorder endusershell entry environ"
    " erand48 erand48_r erf erfc err error error_at_line error_message_count error_one_per_line"
    " error_print_progname errx euidaccess execl execle execlp execv execve execveat execvp"
    " execvpe exit exp exp10 exp2 explicit_bzero expm1 f_owner_ex fabs faccessat fadd faddl"
    " fallocate fchdir fchmod fchmodat fchown fchownat fclose fcloseall fcntl fcvt fcvt_r fd_mask"
    " fd_set fdatasync fdim fdiv fdivl fdopen fdopendir feclearexcept fedisableexcept"
    " feenableexcept fegetenv fegetexcept fegetexceptflag fegetmode fegetround feholdexcept feof"
    " feof_unlocked feraiseexcept ferror ferror_unlocked fesetenv fesetexcept fesetexceptflag"
    " fesetmode fesetround fetestexcept fetestexceptflag feupdateenv fexecve fflush"
    " fflush_unlocked ffma ffmal ffs ffsl ffsll fgetc fgetc_unlocked fgetpos fgets fgets_unlocked"
    " fgetwc fgetwc_unlocked fgetws fgetws_unlocked file_handle fileno fileno_unlocked finite"
    " flock flockfile floor fma fmax fmemopen fmin fmod fmul fmull fopen fopencookie fork"
    " fpathconf fpclassify fprintf fputc fputc_unlocked fputs fputs_unlocked fputwc"
    " fputwc_unlocked fputws fputws_unlocked fread fread_unlocked free freelocale freopen frexp"
    " fromfp fromfpx fromfpxf fromfpxl fscanf fseek fseeko fsetpos fsqrt fsqrtl fstat fstatat"
    " fsub fsubl fsync ftell ftello ftruncate ftrylockfile funlockfile futimens futimes futimesat"
    " fwide fwprintf fwrite fwrite_unlocked fwscanf gamma gcvt get_current_dir_name getc"
    " getc_unlocked getchar getchar_unlocked getcpu getcwd getdate getdate_err getdate_r getdelim"
    " getdirentries getdomainname getdtablesize getegid getentropy getenv geteuid getgid"
    " getgroups gethostid gethostname getitimer getline getloadavg getlogin getlogin_r getopt"
    " getopt_long getopt_long_only getpagesize getpass getpayload getpeername getpgid getpgrp"
    " getpid getppid getpriority getpt getresgid getresuid getrlimit getrusage getsid getsockname"
    " getsockopt getsubopt gettid gettimeofday getuid getumask getusershell getw getwc"
    " getwc_unlocked getwchar getwchar_unlocked getwd glob glob_pattern_p globfree gmtime"
    " gmtime_r grantpt group_member gsignal hcreate hcreate_r hdestroy hdestroy_r hsearch"
    " hsearch_data hsearch_r hypot ilogb imaxabs imaxdiv index initstate initstate_r insque iovec"
    " isalnum isalnum_l isalpha isalpha_l isascii isatty isblank isblank_l iscanonical iscntrl"
    " iscntrl_l isctype isdigit isdigit_l iseqsig isfdtype isfinite isgraph isgraph_l isgreater"
    " isgreaterequal isinf isless islessequal islessgreater islower islower_l isnan isnormal"
    " isprint isprint_l ispunct ispunct_l issignaling isspace isspace_l isunordered isupper"
    " isupper_l iswalnum iswalnum_l iswalpha iswalpha_l iswblank iswblank_l iswcntrl iswcntrl_l"
    " iswctype iswctype_l iswdigit iswdigit_l iswgraph iswgraph_l iswlower iswlower_l iswprint"
    " iswprint_l iswpunct iswpunct_l iswspace iswspace_l iswupper iswupper_l iswxdigit"
    " iswxdigit_l isxdigit isxdigit_l iszero itimerspec itimerval j0 j1 jmp_buf jn jrand48"
    " jrand48_r kill killpg l64a labs lchmod lchown lcong48 lcong48_r lconv ldexp ldiv leaf lfind"
    " lgamma lgamma_r lgammaf_r lgammal_r linger link linkat listen llabs lldiv llogb llrint"
    " llround localeconv localtime localtime_r lockf log log10 log1p log2 logb longjmp lrand48"
    " lrand48_r lrint lround lsearch lseek lstat lutimes madvise mallinfo mallinfo2 malloc"
    " malloc_info malloc_stats malloc_trim malloc_usable_size mallopt mblen mbrlen mbrtoc16"
    " mbrtoc32 mbrtoc8 mbrtowc mbsinit mbsnrtowcs mbsrtowcs mbstowcs mbtowc memalign memccpy"
    " memchr memcmp memcpy memfd_create memfrob memmem memmove mempcpy memrchr memset mincore"
    " mkdir mkdirat mkdtemp mkfifo mkfifoat mknod mknodat mkostemp mkostemps mkstemp mkstemps"
    " mktemp mktime mlock mlock2 mlockall mmap mmsghdr modf mprotect mrand48 mrand48_r mremap"
    " msghdr msync munlock munlockall munmap name_to_handle_at nan nanosleep nearbyint newlocale"
    " nextafter nextdown nexttoward nextup nice nrand48 nrand48_r obstack obstack_printf"
    " obstack_vprintf on_exit once_flag open open_by_handle_at open_memstream open_wmemstream"
    " openat opendir optarg opterr optind option optopt osockaddr pathconf pause pclose perror"
    " pipe pipe2 poll pollfd popen postorder pow ppoll pread preadv preadv2 preadv64v2 preorder"
    " printf prlimit profil program_invocation_name program_invocation_short_name pselect"
    " psiginfo psignal ptsname ptsname_r putc putc_unlocked putchar putchar_unlocked putenv puts"
    " putw putwc putwc_unlocked putwchar putwchar_unlocked pvalloc pwrite pwritev pwritev2"
    " pwritev64v2 qecvt qecvt_r qelem qfcvt qfcvt_r qgcvt qsort qsort_r quick_exit raise rand"
    " rand_r random random_data random_r rawmemchr read readahead readdir readdir64_r readdir_r"
    " readlink readlinkat readv realloc reallocarray realpath recv recvfrom recvmmsg recvmsg"
    " regcomp regerror regexec regfree remainder remap_file_pages remove remque remquo rename"
    " renameat renameat2 revoke rewind rewinddir rindex rint rlimit rmdir round roundeven rpmatch"
    " rusage sbrk scalb scalbln scalbn scandir scandirat scanf secure_getenv seed48 seed48_r"
    " seekdir select send sendmmsg sendmsg sendto setbuf setbuffer setdomainname setegid setenv"
    " seteuid setgid sethostid sethostname setitimer setjmp setlinebuf setlocale setlogin setns"
    " setpayload setpayloadsig setpayloadsigf setpayloadsigl setpgid setpgrp setpriority setregid"
    " setresgid setresuid setreuid setrlimit setsid setsockopt setstate setstate_r settimeofday"
    " setuid setusershell setvbuf shm_open shm_unlink shutdown sigabbrev_np sigaction sigaddset"
    " sigaltstack sigandset sigblock sigcontext sigdelset sigdescr_np sigemptyset sigevent"
    " sigfillset siggetmask sighold sigignore siginterrupt sigisemptyset sigismember sigjmp_buf"
    " siglongjmp signal signbit signgam significand sigorset sigpause sigpending sigprocmask"
    " sigqueue sigrelse sigreturn sigset sigsetmask sigstack sigsuspend sigtimedwait sigval"
    " sigwait sigwaitinfo sin sincos sinh sleep snprintf sockaddr sockaddr_storage sockatmark"
    " socket socketpair splice sprintf sqrt srand srand48 srand48_r srandom srandom_r sscanf"
    " ssignal stat statx statx_timestamp stderr stdin stdout stpcpy stpncpy strcasecmp"
    " strcasecmp_l strcasestr strcat strchr strchrnul strcmp strcoll strcoll_l strcpy strcspn"
    " strdup strerror strerror_l strerror_r strerrordesc_np strerrorname_np strfromd strfromf"
    " strfroml strfry strftime strftime_l strlen strncasecmp strncasecmp_l strncat strncmp"
    " strncpy strndup strnlen strpbrk strptime strptime_l strrchr strsep strsignal strspn strstr"
    " strtod strtod_l strtof strtof_l strtoimax strtok strtok_r strtol strtol_l strtold strtold_l"
    " strtoll strtoll_l strtoq strtoul strtoul_l strtoull strtoull_l strtoumax strtouq strverscmp"
    " strxfrm strxfrm_l swab swprintf swscanf symlink symlinkat sync sync_file_range syncfs"
    " syscall sysconf system sysv_signal tan tanh tcgetpgrp tcsetpgrp tdelete tdestroy tee"
    " telldir tempnam tfind tgamma tgkill time timegm timelocal times timespec timespec_get"
    " timespec_getres timeval timex timezone tm tmpfile tmpnam tmpnam_r tms toascii tolower"
    " tolower_l totalorder totalordermag totalordermagf totalordermagl toupper toupper_l"
    " towctrans towctrans_l towlower towlower_l towupper towupper_l trunc truncate tsearch"
    " ttyname ttyname_r ttyslot twalk twalk_r tzname tzset u_char u_int u_long u_short ualarm"
    " ucred ufromfp ufromfpx ufromfpxf ufromfpxl uint ulong umask uname ungetc ungetwc unlink"
    " unlinkat unlockpt unsetenv unshare uselocale ushort usleep utimensat utimes utsname va_list"
    " valloc vasprintf vdprintf verr verrx versionsort vfork vfprintf vfscanf vfwprintf vfwscanf"
    " vhangup vmsplice vprintf vscanf vsnprintf vsprintf vsscanf vswprintf vswscanf vwarn vwarnx"
    " vwprintf vwscanf wait wait3 wait4 waitid waitpid warn warnx wcpcpy wcpncpy wcrtomb"
    " wcscasecmp wcscasecmp_l wcscat wcschr wcschrnul wcscmp wcscoll wcscoll_l wcscpy wcscspn"
    " wcsdup wcsftime wcsftime_l wcslen wcsncasecmp wcsncasecmp_l wcsncat wcsncmp wcsncpy wcsnlen"
    " wcsnrtombs wcspbrk wcsrchr wcsrtombs wcsspn wcsstr wcstod wcstod_l wcstof wcstof_l"
    " wcstoimax wcstok wcstol wcstol_l wcstold wcstold_l wcstoll wcstoll_l wcstombs wcstoq"
    " wcstoul wcstoul_l wcstoull wcstoull_l wcstoumax wcstouq wcswcs wcswidth wcsxfrm wcsxfrm_l"
    " wctob wctomb wctrans wctrans_l wctype wctype_l wcwidth wmemchr wmemcmp wmemcpy wmemmove"
    " wmempcpy wmemset wprintf write writev wscanf y0 y1 yn"
    " ";

constexpr std::string_view kGlobalFamilies =
    " clock_ cnd_ gnu_ hamgen_ mtx_ pkey_ posix_ process_ pthread_ sched_ sem_ thrd_ timer_ tss_ ";

// Of an emitted plugin.
constexpr std::string_view kPlugin =
    " advance carried create destroy energy_of get_carry get_state gradient_of high_part "
    "invariants_of plugin "
    "read_parameters read_state restore_run save_run tangent_of ";

using Words = std::unordered_set<std::string_view>;

Words words_of(std::string_view list) {
  Words words;
  for (std::size_t begin = 1; begin < list.size();) {
    const std::size_t end = std::min(list.find(' ', begin), list.size());
    words.insert(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

struct Lists {
  Words macros = words_of(kMacros);
  Words macro_families = words_of(kMacroFamilies);
  Words globals = words_of(kGlobals);
  Words global_families = words_of(kGlobalFamilies);
  Words plugin = words_of(kPlugin);
};

const Lists& lists() {
  static const Lists all;
  return all;
}

// Is a beginning of the name in the list?
bool is_of_family(const Words& list, std::string_view name) {
  for (std::size_t length = 1; length < name.size(); ++length) {
    if (list.contains(name.substr(0, length))) return true;
  }
  return false;
}

// cos for cosf, cosl, cosf32x, cosq; stat for stat64; M_PI for M_PIf.
std::string_view stem_of_variant(std::string_view name) {
  constexpr std::string_view kSuffixes[] = {"f32x", "f64x", "f128", "f32", "f64",
                                            "64",   "f",    "l",    "q"};
  const auto* const suffix =
      std::ranges::find_if(kSuffixes, [&](std::string_view each) { return name.ends_with(each); });
  return suffix == std::end(kSuffixes) ? name : name.substr(0, name.size() - suffix->size());
}

}  // namespace

bool is_macro(std::string_view name) {
  const auto is_small = [](char c) { return 'a' <= c && c <= 'z'; };
  return lists().macros.contains(name) ||
         (std::ranges::none_of(name, is_small) && is_of_family(lists().macro_families, name)) ||
         (name.starts_with("M_") && stem_of_variant(name) != name &&
          std::ranges::none_of(stem_of_variant(name), is_small));
}

bool is_global(std::string_view name) {
  return is_macro(name) || lists().globals.contains(name) || lists().plugin.contains(name) ||
         is_of_family(lists().global_families, name) ||
         lists().globals.contains(stem_of_variant(name)) || name.ends_with("_t");
}

}  // namespace hamgen
